//! Sizes and hashes of everything that a run reads, and what they make of its sequences.

use super::{Observer, Stage, fingerprint};
use crate::error::DataError;
use crate::frames::side_by_side;
use crate::read::{Recording, SequenceReader};
use crate::result::{Input, changed_ns, hash_file};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// What makes a sequence's results what they are.
pub(super) struct Identity {
    /// Its name.
    pub(super) name: String,
    /// Equal where the results are equal.
    pub(super) fingerprint: String,
    /// By name.
    pub(super) inputs: Vec<Input>,
}

/// The recording's sequences in a run of this fingerprint. A file that is known by name, size and time is not read
/// again.
pub(super) fn identify(
    recording: &Recording,
    run: &str,
    known: &[Input],
    jobs: usize,
    observer: &dyn Observer,
) -> Result<Vec<Identity>, DataError> {
    let hashes = hash_inputs(recording, known, jobs, observer)?;
    let identity = |reader: &dyn SequenceReader| {
        let name = reader.sequence().name.clone();
        // Sorted, and each but once.
        let files: BTreeSet<PathBuf> = reader.inputs().into_iter().collect();
        let hashes = files.iter().filter_map(|file| hashes.get(file));
        let inputs: Vec<_> = hashes.map(|input| Input { sequence: name.clone(), ..input.clone() }).collect();
        let fingerprint = fingerprint::of_sequence(run, &name, &inputs);
        Identity { name, fingerprint, inputs }
    };
    Ok(recording.sequences.iter().map(|reader| identity(reader.as_ref())).collect())
}

/// Hashes every input of the recording's sequences: each file once, for sequences may share some.
fn hash_inputs(
    recording: &Recording,
    known: &[Input],
    jobs: usize,
    observer: &dyn Observer,
) -> Result<BTreeMap<PathBuf, Input>, DataError> {
    let known: BTreeMap<&str, &Input> = known.iter().map(|input| (input.file.as_str(), input)).collect();
    let files: BTreeSet<PathBuf> = recording.sequences.iter().flat_map(|reader| reader.inputs()).collect();
    let files: Vec<PathBuf> = files.into_iter().collect();
    let sizes = files.iter().filter_map(|file| std::fs::metadata(file).ok());
    observer.begin(Stage::Inputs, sizes.map(|data| data.len()).sum());
    let hashed = side_by_side(&files, jobs, |file| {
        if observer.stopped() {
            return Err(DataError::Stopped);
        }
        Ok((file.clone(), input(file, &recording.path, &known, observer)))
    });
    observer.end();
    Ok(hashed?.into_iter().collect())
}

/// What the record keeps of a file. One that can't be read has no hash and costs the run nothing: a scan that needs it
/// is named when it is read.
fn input(file: &Path, root: &Path, known: &BTreeMap<&str, &Input>, observer: &dyn Observer) -> Input {
    let name = file.strip_prefix(root).unwrap_or(file).to_string_lossy().into_owned();
    // The time before the content: what is changed meanwhile counts as changed later.
    let meta = std::fs::metadata(file).ok();
    let (size, mtime_ns) = (meta.as_ref().map(|meta| meta.len()), meta.as_ref().and_then(changed_ns));
    let same =
        |known: &&&Input| mtime_ns.is_some() && (Some(known.bytes), known.mtime_ns) == (size, mtime_ns);
    if let Some(known) = known.get(name.as_str()).filter(same) {
        observer.advance(known.bytes, 0);
        return (*known).clone();
    }
    let found = hash_file(file, &|bytes| observer.advance(bytes, 0)).unwrap_or_default();
    Input { sequence: String::new(), file: name, bytes: found.bytes, mtime_ns, blake3: found.blake3 }
}
