//! Whose labels a run has kept that isn't over.

use super::Task;
use super::scan_log::scans_in;
use crate::disk::files;
use crate::error::DataError;
use crate::result::json::read_json;
use crate::result::{Input, SequenceRecord};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};

/// A finished sequence and what it was read from.
pub(super) type Finished = (SequenceRecord, Vec<Input>);

/// What a sequence is labelled from.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Origin {
    /// Where the recording lies, the same by all its names; empty where nothing tells.
    pub(super) recording: String,
    /// Its files.
    pub(super) inputs: Vec<Input>,
}

/// Labels of a sequence, of some scans or of all.
#[derive(Debug)]
pub(super) struct Kept {
    pub(super) name: String,
    pub(super) fingerprint: String,
    pub(super) origin: Origin,
    /// Whether the run that is asked for leaves them where they are, unless it labels the sequence anew.
    pub(super) stays: bool,
    /// What tells of them.
    pub(super) file: PathBuf,
}

/// Where a recording lies, the same by all its names; empty where it isn't on disk.
pub(super) fn place_of(recording: &Path) -> String {
    recording.canonicalize().map_or_else(|_| String::new(), |place| place.to_string_lossy().into_owned())
}

impl Origin {
    /// Of a sequence, which is read from these files.
    pub(super) fn of(task: &Task, inputs: &[Input]) -> Self {
        Self { recording: place_of(task.root), inputs: inputs.to_vec() }
    }
}

impl Kept {
    /// A finished sequence, by its record; nothing is known of one that is not whole.
    pub(super) fn finished(file: PathBuf, stays: bool) -> Option<Self> {
        let (sequence, inputs): Finished = read_json(&file).ok()?;
        let origin = Origin { recording: sequence.recording, inputs };
        Some(Self { name: sequence.name, fingerprint: sequence.fingerprint, origin, stays, file })
    }

    /// The sequences under way in a folder that have labels, by what is told of them; an older version told nothing.
    pub(super) fn under_way(
        folder: &Path,
        fingerprint: &str,
        file: PathBuf,
        stays: bool,
    ) -> Result<Vec<Self>, DataError> {
        let Ok(origin) = read_json::<Origin>(&file) else { return Ok(Vec::new()) };
        let mut found = Vec::new();
        for name in files::folders(folder)? {
            if !scans_in(&folder.join(&name))?.is_empty() {
                let (origin, file) = (origin.clone(), file.clone());
                found.push(Self { name, fingerprint: fingerprint.to_owned(), origin, stays, file });
            }
        }
        Ok(found)
    }
}
