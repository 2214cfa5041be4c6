//! The chunks of a file, decompressed when a message of theirs is asked for. The last ones used are kept.

use super::decompress::{CHUNK_BYTES, Compression};
use super::error::ContainerError;
use std::collections::{BTreeMap, VecDeque};
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

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

/// Why a chunk can't be unpacked: what was expected and what was found.
#[derive(Debug, Clone)]
struct Broken(String, String);

/// A file and its chunks. Any thread may ask for any chunk.
#[derive(Debug)]
pub(super) struct Chunks {
    path: PathBuf,
    file: Mutex<File>,
    places: Vec<ChunkPlace>,
    /// The last used one last.
    cache: Mutex<VecDeque<(usize, Arc<[u8]>)>>,
    /// Those that can't be unpacked, for each of their messages asks again.
    broken: Mutex<BTreeMap<usize, Broken>>,
}

impl Chunks {
    pub(super) fn new(path: PathBuf, file: File, places: Vec<ChunkPlace>) -> Self {
        Self { path, file: Mutex::new(file), places, cache: Mutex::default(), broken: Mutex::default() }
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    pub(super) fn len(&self) -> usize {
        self.places.len()
    }

    /// Whether the file ends before the chunk does.
    pub(super) fn is_cut(&self, chunk: usize) -> bool {
        self.places.get(chunk).is_some_and(|place| place.cut)
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
        let known = self.broken().get(&chunk).cloned();
        let unpacked = known.map_or_else(|| self.unpack(&place), |broken| Ok(Err(broken)))?;
        unpacked.map(|bytes| self.keep(chunk, bytes.into())).map_err(|broken| {
            self.broken().insert(chunk, broken.clone());
            let Broken(expected, found) = broken;
            ContainerError::content(&self.path, self.describe(chunk), expected, found)
        })
    }

    /// The bytes of a chunk, or why it has none that are good.
    fn unpack(&self, place: &ChunkPlace) -> Result<Result<Vec<u8>, Broken>, ContainerError> {
        let ChunkPlace { position, stored, size, compression, crc, cut } = *place;
        if size > CHUNK_BYTES {
            return Ok(Err(Broken(format!("at most {CHUNK_BYTES} bytes, decompressed"), size.to_string())));
        }
        let stored = self.bytes(position, stored)?;
        if cut {
            return Ok(Ok(compression.decompress_beginning(stored, size).0));
        }
        let bytes = match compression.decompress(stored, size) {
            Ok(bytes) => bytes,
            Err(found) => return Ok(Err(Broken(format!("{size} bytes, decompressed"), found))),
        };
        let found = if crc == 0 { crc } else { crc32fast::hash(&bytes) };
        if found == crc {
            return Ok(Ok(bytes));
        }
        Ok(Err(Broken(format!("the checksum {crc:#010x}"), format!("{found:#010x}"))))
    }

    fn broken(&self) -> MutexGuard<'_, BTreeMap<usize, Broken>> {
        // Nobody panics while it is held.
        self.broken.lock().unwrap_or_else(PoisonError::into_inner)
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
