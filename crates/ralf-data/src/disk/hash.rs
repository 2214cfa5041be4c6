//! What tells two contents of a file apart.

use super::files;
use crate::error::DataError;
use std::io::Read;
use std::path::Path;

/// Bytes that are hashed at once.
const CHUNK: usize = 1 << 20;

/// A file's size in bytes and its BLAKE3 hash. `advance` is told how many bytes more are done.
pub(crate) fn hash(file: &Path, advance: &dyn Fn(u64)) -> Result<(u64, String), DataError> {
    let (mut open, length) = files::open_input(file)?;
    let mut hasher = blake3::Hasher::new();
    // Most files are far smaller than a chunk; one byte more, for they end with a read that finds nothing.
    let mut buffer = vec![0; usize::try_from(length).map_or(CHUNK, |length| CHUNK.min(length + 1))];
    let mut bytes = 0;
    loop {
        let read = open.read(&mut buffer).map_err(DataError::io(file))?;
        if read == 0 {
            return Ok((bytes, hasher.finalize().to_hex().to_string()));
        }
        hasher.update(&buffer[..read]);
        bytes += read as u64;
        advance(read as u64);
    }
}
