//! The output folder while a run is under way.
//!
//! `OUT/.ralf-run/FINGERPRINT/SEQUENCE/RADAR/000000.rows` hold labelled scans, `SEQUENCE.json` a finished sequence. Results of
//! other runs are of no use once the fingerprint differs, and are removed, finished or not. `run.json` comes last: a folder that
//! has it is complete.

use super::record::{ImageRecord, RunRecord, SequenceRecord};
use super::results::{Results, remove_file};
use crate::files::{self, read, write_whole};
use crate::label_file::write_labels;
use crate::output::{Columns, ScanTable, read_rows, write_rows};
use crate::{DataError, SequenceReader};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Where runs keep what is not finished.
const UNFINISHED: &str = ".ralf-run";
/// The record of a finished run.
pub(crate) const RECORD: &str = "run.json";

/// The output folder of one run.
pub(super) struct Workspace {
    out: PathBuf,
    results: Results,
    unfinished: PathBuf,
    fingerprint: String,
    /// Held while an image's record is written: several workers may ask about one image at the same time.
    image_records: Mutex<()>,
}

impl Workspace {
    /// Makes the folder ready for a run: what other runs left there is removed.
    pub(super) fn open(out: &Path, record: &RunRecord) -> Result<Self, DataError> {
        let fingerprint = record.fingerprint.clone();
        let unfinished = out.join(UNFINISHED).join(&fingerprint);
        let workspace = Self {
            out: out.to_owned(),
            results: Results::of(out),
            unfinished,
            fingerprint,
            image_records: Mutex::default(),
        };
        if workspace.finished().is_none() {
            workspace.remove_other_runs()?;
            fs::create_dir_all(&workspace.unfinished).map_err(DataError::io(&workspace.unfinished))?;
        }
        Ok(workspace)
    }

    /// Results go before the records that tell of them, so that a kill in between leaves none that nobody knows of.
    fn remove_other_runs(&self) -> Result<(), DataError> {
        let record = self.out.join(RECORD);
        // Of a record that this version can't read, nothing is known.
        if let Ok(Some(other)) = read_json::<RunRecord>(&record) {
            other.sequences.iter().try_for_each(|sequence| self.results.remove(sequence))?;
        }
        remove_file(&record)?;
        let all = self.out.join(UNFINISHED);
        for run in files::names(&all)?.iter().map(|name| all.join(name)).filter(|run| *run != self.unfinished)
        {
            self.remove_unfinished(&run)?;
        }
        Ok(())
    }

    /// Removes what a killed run left: its results and what it kept.
    fn remove_unfinished(&self, run: &Path) -> Result<(), DataError> {
        for name in files::names(run)? {
            let kept = run.join(&name);
            if kept.is_dir() {
                self.results.remove_unfinished(&kept, &name)?;
            } else if let Ok(Some(sequence)) = read_json(&kept) {
                self.results.remove(&sequence)?;
            }
        }
        remove_folder(run)
    }

    /// The record of the same run, where it is complete: its results are all there.
    pub(super) fn finished(&self) -> Option<RunRecord> {
        // A record that this version can't read is another run's.
        let record = read_json::<RunRecord>(&self.out.join(RECORD)).unwrap_or(None);
        let is_complete = |record: &RunRecord| {
            record.fingerprint == self.fingerprint
                && record.sequences.iter().all(|sequence| self.results.hold(sequence))
        };
        record.filter(is_complete)
    }

    /// The record of a sequence that an earlier, killed run has finished; one that is not whole is none.
    pub(super) fn finished_sequence(&self, reader: &dyn SequenceReader) -> Option<SequenceRecord> {
        let record = read_json(&self.sequence_record(&reader.sequence().name)).unwrap_or(None);
        record.filter(|record| self.results.hold(record))
    }

    /// Where the result of a sequence goes.
    pub(super) fn plausibility_file(&self, sequence: &str) -> PathBuf {
        self.results.plausibility_file(sequence)
    }

    /// The table of a scan, in a file of its own.
    pub(super) fn rows_file(&self, sequence: &str, radar: &str, scan: usize) -> PathBuf {
        self.unfinished.join(sequence).join(radar).join(format!("{scan:06}.rows"))
    }

    /// Keeps a labelled scan: its table, then its `.label` file, so that no label is without a table that tells of it.
    pub(super) fn keep(
        &self,
        sequence: &str,
        radar: &str,
        scan: usize,
        table: &ScanTable,
    ) -> Result<(), DataError> {
        write_rows(&self.rows_file(sequence, radar, scan), table)?;
        write_labels(&self.results.label_file(sequence, radar, scan), &table.labels())
    }

    /// Whether a scan was labelled before, and both files are whole: a power cut may leave empty ones.
    pub(super) fn has_kept(&self, sequence: &str, radar: &str, scan: usize, columns: &Columns) -> bool {
        let label = fs::metadata(self.results.label_file(sequence, radar, scan));
        let Ok(table) = read_rows(&self.rows_file(sequence, radar, scan), columns) else { return false };
        label.is_ok_and(|label| label.len() == 4 * table.len() as u64)
    }

    /// Keeps what the monitor found about an image.
    pub(super) fn keep_image(
        &self,
        sequence: &str,
        camera: &str,
        record: &ImageRecord,
    ) -> Result<(), DataError> {
        let file = self.image_file(sequence, camera, record.image);
        let _only_one = self.image_records.lock().unwrap_or_else(PoisonError::into_inner);
        if file.exists() { Ok(()) } else { write_json(&file, record) }
    }

    /// What the monitor found about an image; `None` if it was not asked.
    pub(super) fn image(
        &self,
        sequence: &str,
        camera: &str,
        image: usize,
    ) -> Result<Option<ImageRecord>, DataError> {
        read_json(&self.image_file(sequence, camera, image))
    }

    /// Removes the `.label` file that an earlier run with other settings made of a scan that can't be labelled now.
    pub(super) fn forget(&self, sequence: &str, radar: &str, scan: usize) -> Result<(), DataError> {
        self.results.remove_label(sequence, radar, scan)
    }

    /// A sequence's result is in its place; its tables are not needed any more.
    pub(super) fn finish_sequence(&self, record: &SequenceRecord) -> Result<(), DataError> {
        write_json(&self.sequence_record(&record.name), record)?;
        remove_folder(&self.unfinished.join(&record.name))
    }

    /// The run is complete.
    pub(super) fn finish(&self, record: &RunRecord) -> Result<(), DataError> {
        write_json(&self.out.join(RECORD), record)?;
        remove_folder(&self.out.join(UNFINISHED))
    }

    fn image_file(&self, sequence: &str, camera: &str, image: usize) -> PathBuf {
        self.unfinished.join(sequence).join(camera).join(format!("{image:06}.json"))
    }

    fn sequence_record(&self, sequence: &str) -> PathBuf {
        self.unfinished.join(format!("{sequence}.json"))
    }
}

pub(super) fn read_json<T: DeserializeOwned>(file: &Path) -> Result<Option<T>, DataError> {
    if !file.exists() {
        return Ok(None);
    }
    let unreadable = |error: serde_json::Error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        DataError::content(file, place, "a record of `ralf label`", error.to_string())
    };
    serde_json::from_slice(&read(file)?).map(Some).map_err(unreadable)
}

fn write_json<T: Serialize>(file: &Path, value: &T) -> Result<(), DataError> {
    let mut text = serde_json::to_vec_pretty(value).map_err(|error| DataError::io(file)(error.into()))?;
    text.push(b'\n');
    write_whole(file, &text)
}

fn remove_folder(folder: &Path) -> Result<(), DataError> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(DataError::Io { file: folder.to_owned(), error })
        }
        _ => Ok(()),
    }
}
