//! Sizes and hashes of everything that a run reads, and what they make of its sequences.

use super::{Observer, Stage, fingerprint};
use crate::error::DataError;
use crate::read::{Recording, SequenceReader};
use crate::result::{Input, changed_ns, hash_file};
use ralf_jobs::side_by_side;
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// What makes a sequence's results what they are.
pub(super) struct Identity {
    /// Its name.
    pub(super) name: String,
    /// Equal where the results are equal.
    pub(super) fingerprint: String,
    /// What it is read from, by name.
    pub(super) inputs: Vec<Input>,
    /// Whether these tell its content: what lies in memory may be another under the same name.
    pub(super) is_told: bool,
}

/// What the system tells of a file; nothing of one that isn't there.
struct Found {
    size: Option<u64>,
    mtime_ns: Option<i64>,
}

impl Found {
    fn of(file: &Path) -> Self {
        let meta = std::fs::metadata(file).ok();
        Self { size: meta.as_ref().map(|meta| meta.len()), mtime_ns: meta.as_ref().and_then(changed_ns) }
    }
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
    let readers = || recording.sequences.iter().map(AsRef::as_ref);
    let lists: Vec<Vec<PathBuf>> = readers().map(|reader| in_order(reader.inputs())).collect();
    let all = in_order(lists.iter().flatten().cloned().collect());
    let hashes = hash_inputs(&all, &recording.path, known, jobs, observer)?;
    let hashes: HashMap<&Path, Input> = all.iter().map(PathBuf::as_path).zip(hashes).collect();
    let identity = |(reader, files): (&dyn SequenceReader, &Vec<PathBuf>)| {
        let name = reader.sequence().name.clone();
        let hashes = files.iter().filter_map(|file| hashes.get(file.as_path()));
        let inputs: Vec<_> = hashes.map(|input| Input { sequence: name.clone(), ..input.clone() }).collect();
        let fingerprint = fingerprint::of_sequence(run, &name, &inputs);
        Identity { name, fingerprint, inputs, is_told: is_told(reader) }
    };
    Ok(readers().zip(&lists).map(identity).collect())
}

/// Whether the innermost reader has files: those that change what it reads may have some of their own.
fn is_told(reader: &dyn SequenceReader) -> bool {
    reader.inner().map_or_else(|| !reader.inputs().is_empty(), is_told)
}

/// Files by name, each but once. A sensor's follow each other already, which sorting makes use of.
fn in_order(mut files: Vec<PathBuf>) -> Vec<PathBuf> {
    files.sort();
    files.dedup();
    files
}

/// Hashes files, in their order: each once, for sequences may share some.
fn hash_inputs(
    files: &[PathBuf],
    root: &Path,
    known: &[Input],
    jobs: usize,
    observer: &dyn Observer,
) -> Result<Vec<Input>, DataError> {
    let known: HashMap<&str, &Input> = known.iter().map(|input| (input.file.as_str(), input)).collect();
    // The time before the content: what is changed meanwhile counts as changed later.
    let files: Vec<_> = files.iter().map(|file| (file, Found::of(file))).collect();
    observer.begin(Stage::Inputs, files.iter().filter_map(|(_, found)| found.size).sum());
    let hashed = side_by_side(&files, jobs, |(file, found)| {
        if observer.stopped() {
            return Err(DataError::Stopped);
        }
        Ok(input(file, found, root, &known, observer))
    });
    observer.end();
    hashed
}

/// What the record keeps of a file. One that can't be read has no hash and costs the run nothing: a scan that needs it
/// is named when it is read.
fn input(
    file: &Path,
    found: &Found,
    root: &Path,
    known: &HashMap<&str, &Input>,
    observer: &dyn Observer,
) -> Input {
    let name = Input::name(file, root);
    let Found { size, mtime_ns } = *found;
    let same = |known: &&&Input| {
        // One that could not be read when it was listed may be readable now.
        let was_read = !known.blake3.is_empty();
        was_read && mtime_ns.is_some() && (Some(known.bytes), known.mtime_ns) == (size, mtime_ns)
    };
    if let Some(known) = known.get(name.as_str()).filter(same) {
        observer.advance(known.bytes, 0);
        return (*known).clone();
    }
    let found = hash_file(file, &|bytes| observer.advance(bytes, 0)).unwrap_or_default();
    Input { sequence: String::new(), file: name, bytes: found.bytes, mtime_ns, blake3: found.blake3 }
}
