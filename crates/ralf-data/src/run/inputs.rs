//! Sizes and hashes of everything that a run reads.

use super::record::Input;
use super::{Observer, Stage};
use crate::{DataError, Recording};
use std::collections::BTreeSet;
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Bytes that are read at a time.
const CHUNK: usize = 1 << 20;

/// Hashes every input of the recording's sequences, each file once, in the order of their paths.
pub(super) fn hash_inputs(
    recording: &Recording,
    jobs: usize,
    observer: &dyn Observer,
) -> Result<Vec<Input>, DataError> {
    let files: BTreeSet<PathBuf> = recording.sequences.iter().flat_map(|reader| reader.inputs()).collect();
    let files: Vec<PathBuf> = files.into_iter().collect();
    let sizes =
        files.iter().map(|file| std::fs::metadata(file).map(|data| data.len()).map_err(DataError::io(file)));
    let total = sizes.sum::<Result<u64, _>>()?;
    observer.begin(Stage::Inputs, total);
    let next = AtomicUsize::new(0);
    let hashed = Mutex::new(Vec::with_capacity(files.len()));
    std::thread::scope(|scope| {
        for _ in 0..jobs.max(1) {
            scope.spawn(|| {
                while let Some(file) = files.get(next.fetch_add(1, Ordering::Relaxed)) {
                    let input = hash(file, &recording.path, observer);
                    hashed.lock().unwrap_or_else(PoisonError::into_inner).push(input);
                }
            });
        }
    });
    observer.end();
    let hashed = hashed.into_inner().unwrap_or_else(PoisonError::into_inner);
    let mut inputs = hashed.into_iter().collect::<Result<Vec<_>, _>>()?;
    inputs.sort_by(|a, b| a.file.cmp(&b.file));
    Ok(inputs)
}

fn hash(file: &Path, root: &Path, observer: &dyn Observer) -> Result<Input, DataError> {
    let mut open = File::open(file).map_err(DataError::io(file))?;
    let mut hasher = blake3::Hasher::new();
    let mut buffer = vec![0; CHUNK];
    let mut bytes = 0;
    loop {
        let read = open.read(&mut buffer).map_err(DataError::io(file))?;
        if read == 0 {
            break;
        }
        hasher.update(&buffer[..read]);
        bytes += read as u64;
        observer.advance(read as u64, 0);
    }
    let name = file.strip_prefix(root).unwrap_or(file).to_string_lossy().into_owned();
    Ok(Input { file: name, bytes, blake3: hasher.finalize().to_hex().to_string() })
}
