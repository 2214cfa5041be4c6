//! What runs keep in the output folder until `run.json` tells of it.
//!
//! `OUT/.ralf-run/RUN/FINGERPRINT/` holds a sequence under way, `FINGERPRINT.json` a finished one. Both names are
//! fingerprints: of program and settings, and of the sequence.

use super::fingerprint;
use super::inputs::Identity;
use super::results::Results;
use crate::disk::files;
use crate::error::DataError;
use crate::result::json::{read_json, write_json};
use crate::result::{Component, Input, OutFolder, RunRecord, SequenceRecord, checked};
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Of all runs.
pub(super) const FOLDER: &str = ".ralf-run";

/// A finished sequence and what it was read from.
pub(super) type Finished = (SequenceRecord, Vec<Input>);

/// The folder of runs with the same program and settings.
pub(super) struct Unfinished {
    all: OutFolder,
    /// Fingerprint of program and settings.
    run: Component,
}

impl Unfinished {
    pub(super) fn of(out: &OutFolder, run: &RunRecord) -> Result<Self, DataError> {
        let run = checked("fingerprint of a run", &fingerprint::of_run(run))?;
        Ok(Self { all: out.own(FOLDER), run })
    }

    fn folder(&self) -> OutFolder {
        self.all.folder(&self.run)
    }

    /// The scans of a sequence under way.
    pub(super) fn scans(&self, sequence: &Identity, name: &Component) -> Result<OutFolder, DataError> {
        let fingerprint = checked("fingerprint of a sequence", &sequence.fingerprint)?;
        Ok(self.folder().folder(&fingerprint).folder(name))
    }

    /// Sequences that were finished by runs which were killed later; a record that is not whole is none.
    pub(super) fn finished(&self) -> Result<Vec<Finished>, DataError> {
        let folder = self.folder();
        let names = files::names(folder.path())?.into_iter().filter(|name| name.ends_with(".json"));
        let records = names.filter_map(|name| read_json(&folder.path().join(name)).ok());
        // A record that somebody has edited leads nowhere else.
        Ok(records.filter(|(sequence, _): &Finished| Component::new(&sequence.fingerprint).is_ok()).collect())
    }

    /// Keeps a finished sequence, whose scans are not needed any more.
    pub(super) fn finish(&self, finished: &Finished) -> Result<(), DataError> {
        let fingerprint = checked("fingerprint of a sequence", &finished.0.fingerprint)?;
        write_json(&self.folder().file(&fingerprint.and(".json")), finished)?;
        remove_folder(self.folder().folder(&fingerprint).path())
    }

    /// `run.json` tells of these sequences now.
    pub(super) fn forget<'a>(&self, finished: impl Iterator<Item = &'a str>) -> Result<(), DataError> {
        for fingerprint in finished {
            let fingerprint = checked("fingerprint of a sequence", fingerprint)?;
            remove_folder(self.folder().folder(&fingerprint).path())?;
            files::remove(&self.folder().file(&fingerprint.and(".json")))?;
        }
        // Folders that still hold something stay: that is no failure.
        let _ = fs::remove_dir(self.folder().path());
        let _ = fs::remove_dir(self.all.path());
        Ok(())
    }

    /// Removes what is of no use any more, with its results: other settings, and what is asked for with other inputs.
    pub(super) fn remove_outdated(&self, asked: &[Identity], results: &Results) -> Result<(), DataError> {
        for run in files::folders(self.all.path())? {
            let folder = self.all.path().join(&run);
            for name in files::names(&folder)? {
                let kept = folder.join(&name);
                if run != self.run.as_str() {
                    remove_with_results(&kept, results)?;
                } else if kept.is_dir() && is_outdated(&kept, &name, asked)? {
                    results.remove_unfinished(&kept)?;
                    remove_folder(&kept)?;
                }
            }
            if run != self.run.as_str() {
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
