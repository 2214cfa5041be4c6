//! Labelling a recording: in parallel, in bounded memory, resumable, and the same to the byte whatever the number of
//! jobs.
//!
//! Every scan's label depends on the recording and the settings alone, so that scans may be labelled in any order.
//! Their tables are kept in files that only grow until a sequence is complete, and then put together in the order of
//! the rig. A run that was killed finds them again by a fingerprint of program, settings and the sequence's inputs, and
//! a sequence that was labelled before is left as it is. One that has no files can't be told from another of its name,
//! and is always labelled anew.

mod any_labeler;
mod assemble;
mod checks;
mod earlier;
mod entering;
mod fingerprint;
mod in_memory;
mod inputs;
mod kept;
mod not_read;
mod observer;
mod other_recording;
mod output_folder;
mod place;
mod results;
mod scan_log;
mod sequences;
mod stretch;
mod told;
mod unfinished;
mod warnings;
mod without;
mod workers;
mod workspace;

pub use crate::result::{
    CameraRecord, CheckLine, CheckRecord, ImageRecord, Input, NotLabelled, RadarRecord, RunRecord,
    SequenceRecord, Timings, UnlikeSisters, UnreadMeasurement, UnreadableScan, WithoutNumbers, read_record,
};

pub use checks::check_all;
pub use earlier::Earlier;
pub use in_memory::InMemory;
pub use observer::{Observer, Part, Stage, Unwatched};
pub(crate) use place::check_folder_of_many;
pub use place::check_output_folder;
pub use stretch::{Planned, Stretch, StretchOutcome};
pub use warnings::told_gone;

use crate::error::DataError;
use crate::frames::{ScanIndex, all_scans, in_time, time_of};
use crate::read::{Recording, SequenceReader};
use crate::result::{CLASS_FROM, Schema, SequenceNames, evidence_columns, learned_columns};
use crate::settings::Settings;
use any_labeler::AnyLabeler;
use kept::place_of;
use ralf::config::{Config, Method};
use ralf::learned::Model;
use ralf::sensors::{Rig, Timelines};
use std::collections::BTreeSet;
use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

/// A labelling run.
pub struct LabelRun<'a> {
    /// What is labelled.
    pub recording: &'a Recording,
    /// With these settings.
    pub settings: &'a Settings,
    /// Where the results go.
    pub out: &'a Path,
    /// Threads.
    pub jobs: usize,
    /// What a check said of its sequences, for the record.
    pub checks: &'a [CheckRecord],
    /// Whether the evidence of [`ralf::evidence`] is gathered, too: a column of the table for each feature.
    pub evidence: bool,
    /// The model that answers where the settings' method is [`Method::Learned`].
    pub model: Option<&'a Model>,
}

/// Is told what a check says of a sequence.
pub type Checked<'a> = dyn Fn(&CheckRecord) + Sync + 'a;

/// How a run ended.
#[derive(Debug)]
pub struct Outcome {
    /// Of the sequences that were asked for: this part of `run.json`.
    pub record: RunRecord,
    /// Names of those that this run has labelled; the others were labelled before, with the same program, settings and
    /// inputs.
    pub labelled: Vec<String>,
    /// What became of earlier results. Of those that are gone it names the sequences that were not asked for; the
    /// others are labelled anew.
    pub earlier: Earlier,
    /// What [`Recording::left_out`] says.
    pub left_out: Vec<String>,
    /// Names of sequences that were labelled from where the recording lies, and of which it holds nothing any more:
    /// their labels stay. None where it was asked for by its sequences.
    pub gone: Vec<String>,
    /// What [`LabelRun::warnings`] says.
    pub warnings: Vec<String>,
}

/// One sequence with the sensors as the settings have them.
struct Task<'a> {
    /// Where the recording lies.
    root: &'a Path,
    reader: &'a dyn SequenceReader,
    /// Of the folders that its results go to.
    names: SequenceNames,
    rig: Rig,
    schema: Arc<Schema>,
    /// Whether evidence is kept.
    evidence: bool,
    labeler: &'a AnyLabeler<'a>,
}

impl Task<'_> {
    /// All scans of all radars, in the order of time.
    fn in_time(&self) -> Vec<ScanIndex> {
        let times = self.times();
        let scans = all_scans(times);
        in_time(times, &scans).into_iter().map(|place| scans[place]).collect()
    }

    /// When each of these was made, ns.
    fn times_of_scans(&self) -> Vec<i64> {
        self.in_time().into_iter().map(|scan| time_of(self.times(), scan)).collect()
    }

    fn times(&self) -> &Timelines {
        &self.reader.sequence().times
    }

    /// How many they are.
    fn scans(&self) -> usize {
        self.times().radars.iter().map(Vec::len).sum()
    }

    /// Whether evidence is gathered: to be kept, or for a model.
    fn gathers_evidence(&self) -> bool {
        self.evidence || self.labeler.asks_model()
    }
}

impl LabelRun<'_> {
    /// Labels every scan of every radar of the sequences that were not labelled before; those without files, always.
    /// Scans that can't be labelled are named in the record, and the run goes on; settings that don't fit the
    /// recording, and results that can't be written, end it, and so does another run that writes to the same folder
    /// ([`DataError::Busy`]).
    pub fn execute(&self, observer: &dyn Observer) -> Result<Outcome, DataError> {
        self.run(observer, None)
    }

    /// Labels as [`Self::execute`] does, and checks all sequences meanwhile ([`ralf_check::check`]), which the record
    /// tells of in place of `checks`. `told` hears of each as soon as it is known, from several threads.
    ///
    /// # Errors
    /// Those of [`Self::execute`].
    pub fn execute_and_check(
        &self,
        observer: &dyn Observer,
        told: &Checked<'_>,
    ) -> Result<Outcome, DataError> {
        self.run(observer, Some(told))
    }

    fn run(&self, observer: &dyn Observer, told: Option<&Checked<'_>>) -> Result<Outcome, DataError> {
        let begun = Instant::now();
        check_output_folder(&self.recording.path, self.out)?;
        let labeler = self.labeler()?;
        let tasks = self.tasks(&labeler)?;
        let (_lock, folder, asked) = self.enter(observer)?;
        let names: Vec<String> = asked.iter().map(|asked| asked.name.clone()).collect();
        let earlier = folder.earlier().clone().and_labelled(&names);
        observer.found(&earlier);
        let pending: Vec<_> =
            tasks.iter().zip(asked).filter(|(_, asked)| !folder.holds(&asked.name)).collect();
        let (finished, checks) = self.label_sequences(pending, &folder, observer, told)?;
        let checks = if told.is_some() { &checks } else { self.checks };
        let labelled = finished.iter().map(|(sequence, _)| sequence.name.clone()).collect();
        let timings = Timings { seconds: begun.elapsed().as_secs_f64(), jobs: self.jobs };
        let mut record = folder.finish(finished, timings, checks)?;
        let gone = self.gone(&record);
        record.retain(|sequence| names.contains(&sequence.name));
        let (left_out, warnings) = (self.recording.left_out(), self.warnings());
        Ok(Outcome { record, labelled, earlier, left_out, gone, warnings })
    }

    /// The sequences of [`Outcome::gone`].
    fn gone(&self, record: &RunRecord) -> Vec<String> {
        let Recording { path, sequences, incomplete, is_selected, .. } = self.recording;
        let read = sequences.iter().map(|reader| reader.sequence().name.as_str());
        let here: BTreeSet<&str> = read.chain(incomplete.iter().map(|one| one.name.as_str())).collect();
        let place = place_of(path);
        let labelled = record.sequences.iter().filter(|sequence| !is_selected && sequence.recording == place);
        labelled.map(|sequence| sequence.name.clone()).filter(|name| !here.contains(name.as_str())).collect()
    }

    /// Every sequence, with the sensors as the settings have them.
    fn tasks<'a>(&'a self, labeler: &'a AnyLabeler<'a>) -> Result<Vec<Task<'a>>, DataError> {
        self.refuse_nothing()?;
        let names = SequenceNames::all(self.recording.sequences.iter().map(AsRef::as_ref))?;
        let tasks = self.recording.sequences.iter().zip(names);
        tasks.map(|(reader, names)| self.task(reader.as_ref(), names, labeler)).collect()
    }

    /// Without a radar scan in any sequence there is nothing to label, and whoever sees an end without error believes
    /// otherwise. What is lost is told of when the others are labelled.
    fn refuse_nothing(&self) -> Result<(), DataError> {
        let readers = &self.recording.sequences;
        let holds_some = |reader: &dyn SequenceReader| {
            let measured = reader.sequence().times.radars.iter().any(|times| !times.is_empty());
            measured || !reader.lost().is_empty() || !reader.absent().is_empty()
        };
        if readers.is_empty() || readers.iter().any(|reader| holds_some(reader.as_ref())) {
            return Ok(());
        }
        Err(DataError::content(&self.recording.path, "radars", "at least one scan to label", "none"))
    }

    /// What `run.json` tells before a sequence is labelled.
    fn record(&self) -> RunRecord {
        RunRecord::new(self.recording, self.settings, self.evidence, self.asked_model())
    }

    /// The model, where the method is one that asks it.
    fn asked_model(&self) -> Option<&Model> {
        self.model.filter(|_| self.settings.method.method == Method::Learned)
    }

    /// What answers with these settings.
    fn labeler(&self) -> Result<AnyLabeler<'_>, DataError> {
        AnyLabeler::new(&self.settings.method, self.model).map_err(|(place, reason)| DataError::Unsuitable {
            file: self.recording.path.clone(),
            place: place.to_owned(),
            reason,
        })
    }

    fn task<'a>(
        &'a self,
        reader: &'a dyn SequenceReader,
        names: SequenceNames,
        labeler: &'a AnyLabeler<'a>,
    ) -> Result<Task<'a>, DataError> {
        if !reader.sequence().motion.is_known() {
            let reason = "the vehicle's motion is not known: odometry, poses or a trajectory is needed";
            return Err(unsuitable(self.recording, reader, reason.to_owned()));
        }
        let rig = rig_of(self.recording, reader, &self.settings.method)?;
        let mut further = if self.evidence { evidence_columns() } else { Vec::new() };
        if labeler.asks_model() {
            further.extend(learned_columns());
        }
        if reader.has_segmentation() {
            further.push(CLASS_FROM);
        }
        // A recording that one method can label the others can, too.
        let any = [evidence_columns(), learned_columns(), vec![CLASS_FROM]].concat();
        let schema = Schema::of(&rig, &any).and_then(|_| Schema::of(&rig, &further));
        let schema = schema.map_err(|reason| unsuitable(self.recording, reader, reason))?;
        let root = &self.recording.path;
        Ok(Task { root, reader, names, rig, schema: Arc::new(schema), evidence: self.evidence, labeler })
    }
}

/// The sensors of a sequence as the settings have them.
pub(crate) fn rig_of(
    recording: &Recording,
    reader: &dyn SequenceReader,
    config: &Config,
) -> Result<Rig, DataError> {
    let mut rig = reader.sequence().rig.clone();
    config
        .apply_to(&mut rig, reader.absent())
        .map_err(|error| unsuitable(recording, reader, error.to_string()))?;
    Ok(rig)
}

fn unsuitable(recording: &Recording, reader: &dyn SequenceReader, reason: String) -> DataError {
    let place = format!("sequence {}", reader.sequence().name);
    DataError::Unsuitable { file: recording.path.clone(), place, reason }
}
