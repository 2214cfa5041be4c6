//! What runs keep in the output folder until `run.json` tells of it.
//!
//! `OUT/.ralf-run/RUN/FINGERPRINT/` holds a sequence under way, `FINGERPRINT.json` a finished one. Both names are fingerprints: of
//! program and settings, and of the sequence.

use super::fingerprint;
use super::inputs::Identity;
use super::json::{read_json, write_json};
use super::record::{Input, RunRecord};
use super::results::Results;
use super::sequence_record::SequenceRecord;
use crate::disk::files;
use crate::error::DataError;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// Of all runs.
const FOLDER: &str = ".ralf-run";

/// A finished sequence and what it was read from.
pub(super) type Finished = (SequenceRecord, Vec<Input>);

/// The folder of runs with the same program and settings.
pub(super) struct Unfinished {
    all: PathBuf,
    /// Fingerprint of program and settings.
    pub(super) run: String,
}

impl Unfinished {
    pub(super) fn of(out: &Path, run: &RunRecord) -> Self {
        Self { all: out.join(FOLDER), run: fingerprint::of_run(run) }
    }

    fn folder(&self) -> PathBuf {
        self.all.join(&self.run)
    }

    /// The scans of a sequence under way.
    pub(super) fn scans(&self, sequence: &Identity) -> PathBuf {
        self.folder().join(&sequence.fingerprint).join(&sequence.name)
    }

    /// Sequences that were finished by runs which were killed later; a record that is not whole is none.
    pub(super) fn finished(&self) -> Result<Vec<Finished>, DataError> {
        let folder = self.folder();
        let names = files::names(&folder)?.into_iter().filter(|name| name.ends_with(".json"));
        Ok(names.filter_map(|name| read_json(&folder.join(name)).ok()).collect())
    }

    /// Keeps a finished sequence, whose scans are not needed any more.
    pub(super) fn finish(&self, finished: &Finished) -> Result<(), DataError> {
        let folder = self.folder().join(&finished.0.fingerprint);
        write_json(&folder.with_extension("json"), finished)?;
        remove_folder(&folder)
    }

    /// `run.json` tells of these sequences now.
    pub(super) fn forget<'a>(&self, finished: impl Iterator<Item = &'a str>) -> Result<(), DataError> {
        for fingerprint in finished {
            let folder = self.folder().join(fingerprint);
            remove_folder(&folder)?;
            files::remove(&folder.with_extension("json"))?;
        }
        // Folders that still hold something stay: that is no failure.
        let _ = fs::remove_dir(self.folder());
        let _ = fs::remove_dir(&self.all);
        Ok(())
    }

    /// Removes what is of no use any more, with its results: other settings, and what is asked for with other inputs.
    pub(super) fn remove_outdated(&self, asked: &[Identity], results: &Results) -> Result<(), DataError> {
        for run in files::folders(&self.all)? {
            let folder = self.all.join(&run);
            for name in files::names(&folder)? {
                let kept = folder.join(&name);
                if run != self.run {
                    remove_with_results(&kept, results)?;
                } else if kept.is_dir() && is_outdated(&kept, &name, asked)? {
                    results.remove_unfinished(&kept)?;
                    remove_folder(&kept)?;
                }
            }
            if run != self.run {
                remove_folder(&folder)?;
            }
        }
        Ok(())
    }
}

/// Whether a sequence under way is asked for, but with other inputs.
fn is_outdated(kept: &Path, fingerprint: &str, asked: &[Identity]) -> Result<bool, DataError> {
    let names = files::folders(kept)?;
    Ok(asked.iter().any(|asked| asked.fingerprint != fingerprint && names.contains(&asked.name)))
}

/// Removes the results that a finished sequence or one under way tells of.
fn remove_with_results(kept: &Path, results: &Results) -> Result<(), DataError> {
    if kept.is_dir() {
        return results.remove_unfinished(kept);
    }
    // Of a record that can't be read, nothing is known.
    read_json::<Finished>(kept).map_or(Ok(()), |(sequence, _)| results.remove(&sequence))
}

fn remove_folder(folder: &Path) -> Result<(), DataError> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(DataError::Io { file: folder.to_owned(), error })
        }
        _ => Ok(()),
    }
}
