//! What runs keep in the output folder until `run.json` tells of it.
//!
//! `OUT/.ralf-run/RUN/FINGERPRINT/` holds a sequence under way, `FINGERPRINT.json` a finished one. Both names are
//! fingerprints: of program and settings, and of the sequence. `FINGERPRINT/recording.json` tells where a sequence
//! under way comes from; one that is labelled in parts has `FINGERPRINT/inputs.json`, too, what it was read from.

use super::earlier::Earlier;
use super::fingerprint;
use super::inputs::Identity;
use super::kept::{Finished, Kept, Origin};
use super::results::Results;
use crate::disk::files;
use crate::error::DataError;
use crate::result::json::{read_json, write_json};
use crate::result::{Component, Input, OutFolder, RunRecord, checked};
use crate::tree::UNFINISHED;
use std::fs;
use std::io::ErrorKind;
use std::path::Path;

/// Of a sequence under way.
const ORIGIN: &str = "recording.json";
/// Of a sequence that is labelled in parts.
const INPUTS: &str = "inputs.json";

/// The folder of runs with the same program and settings.
pub(super) struct Unfinished {
    all: OutFolder,
    /// Fingerprint of program and settings.
    run: Component,
}

impl Unfinished {
    pub(super) fn of(out: &OutFolder, run: &RunRecord) -> Result<Self, DataError> {
        let run = checked("fingerprint of a run", &fingerprint::of_run(run))?;
        Ok(Self { all: out.own(UNFINISHED), run })
    }

    fn folder(&self) -> OutFolder {
        self.all.folder(&self.run)
    }

    /// The scans of a sequence under way.
    pub(super) fn scans(&self, fingerprint: &str, name: &Component) -> Result<OutFolder, DataError> {
        Ok(self.sequence(fingerprint)?.folder(name))
    }

    fn sequence(&self, fingerprint: &str) -> Result<OutFolder, DataError> {
        Ok(self.folder().folder(&checked("fingerprint of a sequence", fingerprint)?))
    }

    /// Keeps where a sequence that is labelled from now on comes from.
    pub(super) fn begin(&self, fingerprint: &str, origin: &Origin) -> Result<(), DataError> {
        let folder = self.sequence(fingerprint)?;
        fs::create_dir_all(folder.path()).map_err(DataError::io(folder.path()))?;
        write_json(&folder.own_file(ORIGIN), origin)
    }

    /// Keeps what a sequence is read from, and makes room for its scans.
    pub(super) fn remember(&self, sequence: &Identity, name: &Component) -> Result<(), DataError> {
        let scans = self.scans(&sequence.fingerprint, name)?;
        fs::create_dir_all(scans.path()).map_err(DataError::io(scans.path()))?;
        write_json(&self.sequence(&sequence.fingerprint)?.own_file(INPUTS), &sequence.inputs)
    }

    /// Whether a sequence is remembered.
    pub(super) fn is_planned(&self, fingerprint: &str) -> Result<bool, DataError> {
        files::exists(&self.sequence(fingerprint)?.own_file(INPUTS))
    }

    /// All inputs that are remembered; a list that is not whole is none, and so is one whose hashes don't make the
    /// fingerprint that it lies under: what it told would become the record's.
    pub(super) fn inputs(&self) -> Result<Vec<Input>, DataError> {
        let folder = self.folder();
        let names = files::folders(folder.path())?;
        let lists = names.iter().filter_map(|name| {
            let inputs: Vec<Input> = read_json(&folder.path().join(name).join(INPUTS)).ok()?;
            let sequence = &inputs.first()?.sequence;
            self.is_of(name, sequence, &inputs).then_some(inputs)
        });
        Ok(lists.flatten().collect())
    }

    /// Sequences that were finished by runs which were killed later; a record that is not whole is none, as is one of
    /// another sequence or other inputs than its name tells.
    pub(super) fn finished(&self) -> Result<Vec<Finished>, DataError> {
        let folder = self.folder();
        let names = files::names(folder.path())?;
        let records = names.iter().filter_map(|name| {
            let fingerprint = name.strip_suffix(".json")?;
            let (sequence, inputs): Finished = read_json(&folder.path().join(name)).ok()?;
            let is_whole =
                sequence.fingerprint == fingerprint && self.is_of(fingerprint, &sequence.name, &inputs);
            is_whole.then_some((sequence, inputs))
        });
        Ok(records.collect())
    }

    /// All sequences of which labels are kept, of this program and these settings and of others.
    pub(super) fn kept(&self) -> Result<Vec<Kept>, DataError> {
        let mut kept = Vec::new();
        for run in files::folders(self.all.path())? {
            let folder = self.all.path().join(&run);
            for name in files::names(&folder)? {
                let stays = run == self.run.as_str();
                let file = folder.join(&name);
                match file.is_dir() {
                    true => kept.extend(Kept::under_way(&file, &name, file.join(ORIGIN), stays)?),
                    false => kept.extend(Kept::finished(file, stays)),
                }
            }
        }
        Ok(kept)
    }

    /// Whether this is the fingerprint of a sequence with these inputs.
    fn is_of(&self, found: &str, sequence: &str, inputs: &[Input]) -> bool {
        fingerprint::of_sequence(self.run.as_str(), sequence, inputs) == found
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
    /// Returns what is gone of other settings.
    pub(super) fn remove_outdated(
        &self,
        asked: &[Identity],
        results: &Results,
    ) -> Result<Earlier, DataError> {
        let mut gone = Earlier::default();
        for run in files::folders(self.all.path())? {
            let folder = self.all.path().join(&run);
            for name in files::names(&folder)? {
                let kept = folder.join(&name);
                if run != self.run.as_str() {
                    gone.add(remove_with_results(&kept, results)?);
                } else if kept.is_dir() && is_outdated(&kept, &name, asked)? {
                    results.remove_unfinished(&kept)?;
                    remove_folder(&kept)?;
                }
            }
            if run != self.run.as_str() {
                remove_folder(&folder)?;
            }
        }
        Ok(gone)
    }
}

/// Whether a sequence under way is asked for, but with other inputs, or with none that would tell its content.
fn is_outdated(kept: &Path, fingerprint: &str, asked: &[Identity]) -> Result<bool, DataError> {
    let names = files::folders(kept)?;
    let is_other = |asked: &Identity| !asked.is_told || asked.fingerprint != fingerprint;
    Ok(asked.iter().any(|asked| is_other(asked) && names.contains(&asked.name)))
}

/// Removes the results that a finished sequence or one under way tells of, and tells whose they were.
fn remove_with_results(kept: &Path, results: &Results) -> Result<Earlier, DataError> {
    let mut gone = Earlier::default();
    if kept.is_dir() {
        gone.unfinished = results.remove_unfinished(kept)?;
    } else if let Ok((sequence, _)) = read_json::<Finished>(kept) {
        // Of a record that can't be read, nothing is known.
        results.remove(&sequence)?;
        gone.removed.push(sequence.name);
    }
    Ok(gone)
}

fn remove_folder(folder: &Path) -> Result<(), DataError> {
    match fs::remove_dir_all(folder) {
        Err(error) if error.kind() != ErrorKind::NotFound => {
            Err(DataError::Io { file: folder.to_owned(), error })
        }
        _ => Ok(()),
    }
}
