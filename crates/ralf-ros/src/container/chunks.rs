//! The chunks of a file, decompressed when a message of theirs is asked for. The last ones used are kept.

use super::decompress::{CHUNK_BYTES, Compression};
use super::error::ContainerError;
use std::collections::VecDeque;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};

/// Bytes of decompressed chunks that are kept; the last one always is.
const CACHE_BYTES: usize = 64 << 20;

/// Where a chunk lies in its file.
#[derive(Debug, Clone, Copy)]
pub(super) struct ChunkPlace {
    /// Where its compressed bytes begin in the file.
    pub(super) position: u64,
    /// How many there are of them.
    pub(super) stored: u64,
    /// How many come out.
    pub(super) size: u64,
    pub(super) compression: Compression,
    /// The checksum of what comes out; 0 where it isn't known.
    pub(super) crc: u32,
    /// Whether the file ends before the chunk does.
    pub(super) cut: bool,
}

/// A file and its chunks. Any thread may ask for any chunk.
#[derive(Debug)]
pub(super) struct Chunks {
    path: PathBuf,
    file: Mutex<File>,
    places: Vec<ChunkPlace>,
    /// The last used one last.
    cache: Mutex<VecDeque<(usize, Arc<[u8]>)>>,
}

impl Chunks {
    pub(super) fn new(path: PathBuf, file: File, places: Vec<ChunkPlace>) -> Self {
        Self { path, file: Mutex::new(file), places, cache: Mutex::default() }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// What an error in a chunk is said of.
    pub(super) fn describe(&self, chunk: usize) -> String {
        self.places.get(chunk).map_or_else(
            || format!("chunk {chunk}"),
            |place| format!("chunk {chunk} (at byte {})", place.position),
        )
    }

    /// A chunk, decompressed; of one that is cut, what is left of it.
    pub(super) fn chunk(&self, chunk: usize) -> Result<Arc<[u8]>, ContainerError> {
        if let Some(found) = self.cached(chunk) {
            return Ok(found);
        }
        let place = *self.places.get(chunk).ok_or_else(|| {
            ContainerError::content(&self.path, "index", "a chunk of the file", format!("chunk {chunk}"))
        })?;
        let wrong = |expected: String, found: String| {
            Err(ContainerError::content(&self.path, self.describe(chunk), expected, found))
        };
        if place.size > CHUNK_BYTES {
            return wrong(format!("at most {CHUNK_BYTES} bytes, decompressed"), format!("{}", place.size));
        }
        let stored = self.bytes(place.position, place.stored)?;
        let bytes = if place.cut {
            place.compression.decompress_beginning(stored, place.size).0
        } else {
            match place.compression.decompress(stored, place.size) {
                Ok(bytes) => bytes,
                Err(found) => return wrong(format!("{} bytes, decompressed", place.size), found),
            }
        };
        let crc = if place.crc == 0 || place.cut { place.crc } else { crc32fast::hash(&bytes) };
        if crc != place.crc {
            return wrong(format!("the checksum {:#010x}", place.crc), format!("{crc:#010x}"));
        }
        Ok(self.keep(chunk, bytes.into()))
    }

    /// Bytes of the file as they are.
    pub(super) fn bytes(&self, position: u64, length: u64) -> Result<Vec<u8>, ContainerError> {
        // A panic elsewhere while it was held leaves a file that is sought again anyway.
        let mut file = self.file.lock().unwrap_or_else(PoisonError::into_inner);
        let mut bytes = Vec::new();
        file.seek(SeekFrom::Start(position))
            .and_then(|_| file.by_ref().take(length).read_to_end(&mut bytes))
            .map_err(ContainerError::io(&self.path))?;
        if bytes.len() as u64 == length {
            return Ok(bytes);
        }
        let place = format!("byte {position}");
        Err(ContainerError::content(&self.path, place, format!("{length} bytes"), format!("{}", bytes.len())))
    }

    fn cached(&self, chunk: usize) -> Option<Arc<[u8]>> {
        let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        let place = cache.iter().position(|(known, _)| *known == chunk)?;
        let found = cache.remove(place)?;
        let bytes = Arc::clone(&found.1);
        cache.push_back(found);
        Some(bytes)
    }

    fn keep(&self, chunk: usize, bytes: Arc<[u8]>) -> Arc<[u8]> {
        let mut cache = self.cache.lock().unwrap_or_else(PoisonError::into_inner);
        // Another thread may have been as fast.
        cache.retain(|(known, _)| *known != chunk);
        cache.push_back((chunk, Arc::clone(&bytes)));
        let mut held: usize = cache.iter().map(|(_, bytes)| bytes.len()).sum();
        while held > CACHE_BYTES && cache.len() > 1 {
            held -= cache.pop_front().map_or(0, |(_, bytes)| bytes.len());
        }
        bytes
    }
}
