//! The one door to what a run left: `OUT` with its `run.json`, its tables and its label files, checked as they are
//! read.

use super::content::{input_is_unchanged, table_is_whole};
use super::record::{Input, RunRecord, read_record};
use super::sequence_record::SequenceRecord;
use super::{Component, Places, PlausibilityReader, Schema};
use crate::disk::files;
use crate::disk::label_file::{Label, labels_of_bytes};
use crate::error::DataError;
use crate::read::open::{is_recognised_as, recognised};
use crate::read::{Recording, SensorCorrection, SequenceReader, layout, open_selected, open_with};
use crate::settings::Settings;
use crate::tree::{DEPTH, RECORD, SEQUENCES};
use ralf::config::Config;
use ralf::sensors::{Rig, Sequence};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An output folder of `ralf label`.
#[derive(Debug, Clone)]
pub struct LabelledRun {
    out: PathBuf,
    places: Places,
    record: RunRecord,
}

/// One sequence of a run, with its labelled detections.
#[derive(Debug)]
pub struct LabelledSequence {
    /// What `run.json` tells of it.
    pub record: SequenceRecord,
    /// The recording's sensors with the settings of the run.
    pub rig: Rig,
    /// The settings of the method that the labels were made with.
    pub settings: Config,
    /// The labelled detections.
    pub tables: PlausibilityReader,
}

/// A run and the dataset that it labelled, as the truth about its labels may lie there: opened with the run's topics
/// and those of its settings that change values of detections, and not yet compared with what was labelled. `None`
/// where nothing or label files alone are, and where the dataset is of another format: labels may be compared with
/// truth that is kept in another.
///
/// # Errors
/// A `run.json` that can't be read; a dataset that can't be opened, at least as far as it was labelled: what can't be
/// read must not count as unchanged.
pub fn labelled_recording(out: &Path, dataset: &Path) -> Result<Option<(LabelledRun, Recording)>, DataError> {
    if !files::exists(&out.join(RECORD))? {
        return Ok(None);
    }
    let run = LabelledRun::open(out)?;
    let format = Some(run.record().format.as_str()).filter(|format| is_recognised_as(dataset, format));
    let is_another = format.is_none() && recognised(dataset).is_some();
    // Of a place where nothing is, truth is told to lack.
    let is_nothing = dataset.metadata().is_err();
    if is_nothing || is_another || layout::holds_labels_alone(dataset) {
        return Ok(None);
    }
    let names: Vec<String> = run.record().sequences.iter().map(|sequence| sequence.name.clone()).collect();
    let topics = &run.settings().topics;
    // What was never labelled may be damaged, as it may be where sequences are labelled by name.
    let recording = open_with(dataset, format, topics)
        .and_then(Recording::whole)
        .or_else(|error| open_selected(dataset, format, topics, &names).map_err(|_| error))?;
    let recording = with_altered_values(&run, recording)?;
    Ok(Some((run, recording)))
}

/// The recording as the run's settings correct it, where these change values of detections: earlier versions of the
/// program knew scans by what that made of them. Other corrections say nothing of truth, and cost time.
fn with_altered_values(run: &LabelledRun, recording: Recording) -> Result<Recording, DataError> {
    let settings = run.settings();
    if settings.corrections.values().any(SensorCorrection::alters_values) {
        settings.correct_labelled(recording, |name| run.holds(name))
    } else {
        Ok(recording)
    }
}

fn is_store(folder: &Path) -> bool {
    folder.join(DEPTH).with_extension("toml").is_file()
}

/// A file that isn't what was labelled.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct ChangedInput {
    /// The sequence that it belongs to.
    pub sequence: String,
    /// Where it lies, or lay.
    pub file: PathBuf,
    /// What became of it.
    pub change: Change,
}

/// What became of an input since it was labelled.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Change {
    /// It has another content.
    Content,
    /// It is gone.
    Missing,
    /// It wasn't there.
    New,
}

impl Change {
    /// In words.
    pub fn told(self) -> &'static str {
        match self {
            Self::Content => "another content",
            Self::Missing => "no such file",
            Self::New => "a file that wasn't there",
        }
    }
}

impl LabelledRun {
    /// Opens an output folder by its `run.json`.
    ///
    /// # Errors
    /// A folder without one, or one that this program can't read.
    pub fn open(out: &Path) -> Result<Self, DataError> {
        Ok(Self { out: out.to_owned(), places: Places::new(out), record: read_record(out)? })
    }

    /// The folder.
    pub fn out(&self) -> &Path {
        &self.out
    }

    /// What `run.json` tells.
    pub fn record(&self) -> &RunRecord {
        &self.record
    }

    /// The settings that the labels were made with.
    pub fn settings(&self) -> &Settings {
        &self.record.settings
    }

    /// Whether a sequence of this name is labelled.
    pub fn holds(&self, sequence: &str) -> bool {
        self.record.sequence(sequence).is_some()
    }

    /// The folders of depth images that sequences were labelled with, apart from a recording's own; of those that are
    /// still there.
    pub fn depth_stores(&self, recording: &Path) -> Vec<PathBuf> {
        self.depth_folders(recording).into_iter().filter(|root| is_store(root)).collect()
    }

    /// Those that are there no more.
    pub fn lost_depth_stores(&self, recording: &Path) -> Vec<PathBuf> {
        self.depth_folders(recording).into_iter().filter(|root| !is_store(root)).collect()
    }

    fn depth_folders(&self, recording: &Path) -> BTreeSet<PathBuf> {
        // STORE/sequences/NAME/CAMERA/depth/000000.npy
        let root = |file: &str| {
            let file = Path::new(file);
            let is_depth =
                file.parent()?.file_name()? == DEPTH && file.ancestors().nth(4)?.ends_with(SEQUENCES);
            file.ancestors().nth(5).filter(|_| is_depth).map(|root| recording.join(root))
        };
        let roots = self.record.inputs.iter().filter_map(|input| root(&input.file));
        roots.filter(|root| *root != recording.join("")).collect()
    }

    /// The files of a recording that are not what was labelled, in the order of their names; of the sequences that were
    /// labelled. A file of the recorded size and time is taken for the same, of any other the content is compared.
    ///
    /// # Errors
    /// A file that can't be read.
    pub fn changes(&self, recording: &Recording) -> Result<Vec<ChangedInput>, DataError> {
        let mut changes = BTreeSet::new();
        for reader in &recording.sequences {
            let name = &reader.sequence().name;
            if !self.holds(name) {
                continue;
            }
            let named = |file: PathBuf| (Input::name(&file, &recording.path), file);
            let mut now: BTreeMap<String, PathBuf> = reader.inputs().into_iter().map(named).collect();
            for input in self.record.inputs.iter().filter(|input| input.sequence == *name) {
                let found = now.remove(&input.file);
                // What lies elsewhere, such as depth beside the labels, may go once it was used.
                if found.is_none() && Path::new(&input.file).is_absolute() {
                    continue;
                }
                let file = found.unwrap_or_else(|| recording.path.join(&input.file));
                if input_is_unchanged(&file, input)? {
                    continue;
                }
                let change = if file.exists() { Change::Content } else { Change::Missing };
                changes.insert(ChangedInput { sequence: name.clone(), file, change });
            }
            let new = now.into_values().map(|file| (file, Change::New));
            changes.extend(new.map(|(file, change)| ChangedInput { sequence: name.clone(), file, change }));
        }
        Ok(changes.into_iter().collect())
    }

    /// Refuses a recording that is not what was labelled, by the first file that differs.
    ///
    /// # Errors
    /// Such a file, and one that can't be read.
    pub fn refuse_changes(&self, recording: &Recording) -> Result<(), DataError> {
        match self.changes(recording)?.first() {
            None => Ok(()),
            Some(changed) => {
                let found = changed.change.told();
                Err(DataError::content(&changed.file, "content", "what was labelled", found))
            }
        }
    }

    /// A sequence as it was labelled.
    ///
    /// # Errors
    /// A sequence that was not labelled, or had other radars or scans then; a table that is damaged.
    pub fn sequence(&self, reader: &dyn SequenceReader) -> Result<LabelledSequence, DataError> {
        let name = &reader.sequence().name;
        let Some(record) = self.record.sequence(name) else {
            return Err(DataError::content(
                &self.out,
                "run.json, sequences",
                format!("labels of {name}"),
                "none",
            ));
        };
        check_radars(&self.out, reader, record)?;
        let mut rig = reader.sequence().rig.clone();
        self.record.settings.method.apply_to(&mut rig, reader.absent()).map_err(|error| {
            DataError::Unsuitable {
                file: self.out.clone(),
                place: format!("sequence {name}"),
                reason: error.to_string(),
            }
        })?;
        let file = self.table_file(record)?;
        let unlike = |found| DataError::content(&file, "columns", "those of the recording's radars", found);
        let schema = Schema::of(&rig, &[]).map_err(unlike)?;
        let tables = PlausibilityReader::open(&file, &schema)?;
        let settings = self.record.settings.method.clone();
        Ok(LabelledSequence { record: record.clone(), rig, settings, tables })
    }

    /// The columns of [`Self::sequence`]'s table, for little more than the opening of its file: whether that is whole
    /// is not looked at.
    ///
    /// # Errors
    /// A table that can't be read, or not of the recording's radars.
    pub(crate) fn columns(&self, reader: &dyn SequenceReader) -> Result<Arc<Schema>, DataError> {
        let Sequence { name, rig, .. } = reader.sequence();
        let file = self.places.plausibility_file(&super::checked("sequence", name)?);
        let unlike = |found| DataError::content(&file, "columns", "those of the recording's radars", found);
        PlausibilityReader::columns_of(&file, &Schema::of(rig, &[]).map_err(unlike)?)
    }

    /// The table of a sequence, with the columns that every result has.
    ///
    /// # Errors
    /// A table that is damaged.
    pub fn table(&self, record: &SequenceRecord) -> Result<PlausibilityReader, DataError> {
        let file = self.table_file(record)?;
        let unlike = |found| DataError::content(&file, "columns", "those of a result", found);
        PlausibilityReader::open(&file, &Schema::of(&Rig::default(), &[]).map_err(unlike)?)
    }

    /// The table of a sequence with all columns that it holds, for whoever doesn't have the recording at hand.
    ///
    /// # Errors
    /// A sequence that was not labelled; a table that is damaged.
    pub fn whole_table(&self, sequence: &str) -> Result<PlausibilityReader, DataError> {
        PlausibilityReader::open_all(&self.table_file(self.told(sequence)?)?)
    }

    /// The columns of that table. Whether it is as it was written is found when its rows are read.
    ///
    /// # Errors
    /// A sequence that was not labelled; a table that is none.
    pub fn whole_columns(&self, sequence: &str) -> Result<Arc<Schema>, DataError> {
        let schema = PlausibilityReader::all_columns_of(&self.place_of_table(self.told(sequence)?)?)?;
        Ok(Arc::new(schema.with_scan()))
    }

    /// What the record tells of a sequence.
    fn told(&self, sequence: &str) -> Result<&SequenceRecord, DataError> {
        let names = || self.record.sequences.iter().map(|record| record.name.as_str()).collect::<Vec<_>>();
        self.record.sequence(sequence).ok_or_else(|| DataError::UnknownSequence {
            name: sequence.to_owned(),
            known: names().join(", "),
        })
    }

    fn place_of_table(&self, record: &SequenceRecord) -> Result<PathBuf, DataError> {
        Ok(self.places.plausibility_file(&super::checked("run.json, sequence", &record.name)?))
    }

    /// Where the table of a sequence lies, once it is found to be as it was written.
    fn table_file(&self, record: &SequenceRecord) -> Result<PathBuf, DataError> {
        let file = self.place_of_table(record)?;
        if table_is_whole(&file, record)? { Ok(file) } else { Err(damaged(&file)) }
    }

    /// The labels of a scan as a run wrote them; `None` where it has none. Only the label file has to be there, but
    /// where `run.json` tells of it, it has to be as it was written.
    pub(crate) fn labels_below(
        out: &Path,
        run: Option<&Self>,
        sequence: &str,
        radar: &str,
        scan: usize,
    ) -> Result<Option<Vec<Label>>, DataError> {
        // Who has a name that no folder can have was not labelled.
        let (Ok(sequence), Ok(radar)) = (Component::new(sequence), Component::new(radar)) else {
            return Ok(None);
        };
        let file = Places::new(out).label_file(&sequence, &radar, scan);
        let record = run.and_then(|run| run.record.sequence(sequence.as_str()));
        let record =
            record.and_then(|record| record.radars.iter().find(|known| known.name == radar.as_str()));
        if !file.try_exists().map_err(DataError::io(&file))? {
            let written =
                record.is_some_and(|record| record.labels.get(scan).is_some_and(|hash| !hash.is_empty()));
            return if written { Err(damaged(&file)) } else { Ok(None) };
        }
        let bytes = files::read(&file)?;
        if record.is_some_and(|record| !record.labels_match(scan, &bytes)) {
            return Err(damaged(&file));
        }
        labels_of_bytes(&file, &bytes).map(Some)
    }
}

/// Refuses results of other radars, or of another number of scans.
fn check_radars(out: &Path, reader: &dyn SequenceReader, record: &SequenceRecord) -> Result<(), DataError> {
    let sequence = reader.sequence();
    let radars = sequence.rig.radars.iter().zip(&sequence.times.radars);
    let recorded: Vec<String> =
        radars.map(|(radar, times)| format!("{} ({})", radar.name, times.len())).collect();
    let labelled: Vec<String> =
        record.radars.iter().map(|radar| format!("{} ({})", radar.name, radar.detections.len())).collect();
    if recorded == labelled {
        return Ok(());
    }
    let place = format!("run.json, sequence {}", record.name);
    let expected = format!("the recording's radars and scans: {}", recorded.join(", "));
    Err(DataError::content(out, place, expected, labelled.join(", ")))
}

fn damaged(file: &Path) -> DataError {
    let expected = "what `ralf label` wrote, as run.json tells it";
    DataError::content(file, "content", expected, "a damaged or missing file: label again")
}
