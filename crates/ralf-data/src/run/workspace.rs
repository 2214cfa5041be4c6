//! The output folder while a run is under way.
//!
//! `OUT/.ralf-run/FINGERPRINT/SEQUENCE/RADAR/000000.rows` hold labelled scans, `SEQUENCE.json` a finished sequence. Results of
//! other runs are of no use once the fingerprint differs, and are removed. `run.json` comes last: a folder that has it is complete.

use super::record::{ImageRecord, RunRecord, SequenceRecord};
use crate::files::{read, write_whole};
use crate::label_file::write_labels;
use crate::output::{ScanTable, write_rows};
use crate::{DataError, SequenceReader};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Where runs keep what is not finished.
const UNFINISHED: &str = ".ralf-run";
/// The record of a finished run.
pub(crate) const RECORD: &str = "run.json";

/// The output folder of one run.
pub(super) struct Workspace {
    out: PathBuf,
    unfinished: PathBuf,
    fingerprint: String,
}

impl Workspace {
    /// Makes the folder ready for a run: what another run left there unfinished is removed.
    pub(super) fn open(out: &Path, record: &RunRecord) -> Result<Self, DataError> {
        let fingerprint = record.fingerprint.clone();
        let workspace =
            Self { out: out.to_owned(), unfinished: out.join(UNFINISHED).join(&fingerprint), fingerprint };
        if workspace.finished()?.is_none() {
            workspace.remove_other_runs()?;
            fs::create_dir_all(&workspace.unfinished).map_err(DataError::io(&workspace.unfinished))?;
        }
        Ok(workspace)
    }

    fn remove_other_runs(&self) -> Result<(), DataError> {
        remove_file(&self.out.join(RECORD))?;
        let all = self.out.join(UNFINISHED);
        let entries = match fs::read_dir(&all) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(()),
            entries => entries.map_err(DataError::io(&all))?,
        };
        for entry in entries {
            let path = entry.map_err(DataError::io(&all))?.path();
            if path != self.unfinished {
                fs::remove_dir_all(&path).map_err(DataError::io(&path))?;
            }
        }
        Ok(())
    }

    /// The record of the same run, where it is complete.
    pub(super) fn finished(&self) -> Result<Option<RunRecord>, DataError> {
        // A record that this version can't read is another run's.
        let record = read_json::<RunRecord>(&self.out.join(RECORD)).unwrap_or(None);
        Ok(record.filter(|record| record.fingerprint == self.fingerprint))
    }

    /// The record of a sequence that an earlier, killed run has finished.
    pub(super) fn finished_sequence(
        &self,
        reader: &dyn SequenceReader,
    ) -> Result<Option<SequenceRecord>, DataError> {
        read_json(&self.sequence_record(&reader.sequence().name))
    }

    /// Where the result of a sequence goes.
    pub(super) fn plausibility_file(&self, sequence: &str) -> PathBuf {
        self.sequence_folder(sequence).join("plausibility.parquet")
    }

    /// The table of a scan, in a file of its own.
    pub(super) fn rows_file(&self, sequence: &str, radar: &str, scan: usize) -> PathBuf {
        self.unfinished.join(sequence).join(radar).join(format!("{scan:06}.rows"))
    }

    /// Keeps a labelled scan: its `.label` file, then its table, whose presence says that the scan is done.
    pub(super) fn keep(
        &self,
        sequence: &str,
        radar: &str,
        scan: usize,
        table: &ScanTable,
    ) -> Result<(), DataError> {
        write_labels(&self.label_file(sequence, radar, scan), &table.labels())?;
        write_rows(&self.rows_file(sequence, radar, scan), table)
    }

    /// Keeps what the monitor found about an image.
    pub(super) fn keep_image(
        &self,
        sequence: &str,
        camera: &str,
        record: &ImageRecord,
    ) -> Result<(), DataError> {
        let file = self.image_file(sequence, camera, record.image);
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
        remove_file(&self.label_file(sequence, radar, scan))
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

    fn sequence_folder(&self, sequence: &str) -> PathBuf {
        self.out.join("sequences").join(sequence)
    }

    fn label_file(&self, sequence: &str, radar: &str, scan: usize) -> PathBuf {
        self.sequence_folder(sequence).join(radar).join(format!("{scan:06}.label"))
    }

    fn sequence_record(&self, sequence: &str) -> PathBuf {
        self.unfinished.join(format!("{sequence}.json"))
    }
}

fn read_json<T: DeserializeOwned>(file: &Path) -> Result<Option<T>, DataError> {
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

fn remove_file(file: &Path) -> Result<(), DataError> {
    match fs::remove_file(file) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(DataError::Io { file: file.to_owned(), error })
        }
        _ => Ok(()),
    }
}

fn remove_folder(folder: &Path) -> Result<(), DataError> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(DataError::Io { file: folder.to_owned(), error })
        }
        _ => Ok(()),
    }
}
