//! Whether the file that is open is still the one that lies there. A file that was deleted or replaced takes
//! every edit, and nobody ever reads it again; of one that was written over, half would be of the one, half of the
//! other.

use crate::alone::Alone;
use crate::error::StoreError;
use ralf_files::database::log;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

/// Another program may be writing its journal back: what is read meanwhile may be half of it.
const TRIES: usize = 10;
const BETWEEN_TRIES: Duration = Duration::from_millis(50);

/// The files of an open store, as they were when it was opened.
#[derive(Debug, Clone)]
pub(crate) struct Identity {
    files: Vec<(PathBuf, FileId)>,
    /// What the store's file held by itself when anybody looked into it last.
    known: Arc<Mutex<Known>>,
}

type FileId = (u64, u64);

/// A file's last change and length: while both are the same, nobody wrote to it.
pub(crate) type Stamp = (Option<SystemTime>, u64);

#[derive(Debug, Clone)]
struct Known {
    stamp: Stamp,
    alone: Alone,
}

impl Identity {
    /// The store's file, and its journal, which lies there as long as anybody has the store open; some file
    /// systems know none.
    pub(crate) fn of_store(file: &Path) -> Result<Self, StoreError> {
        let deleted = |_| StoreError::gone(file, "that it was deleted");
        let id = file_id(file).map_err(deleted)?;
        let known = Known { stamp: stamp(file).map_err(deleted)?, alone: Alone::of(file) };
        let mut files = vec![(file.to_owned(), id)];
        let log = log(file);
        if let Ok(id) = file_id(&log) {
            files.push((log, id));
        }
        Ok(Self { files, known: Arc::new(Mutex::new(known)) })
    }

    /// Refuses to go on where one of them is not there any more, or is another file.
    pub(crate) fn check(&self) -> Result<(), StoreError> {
        for (file, opened) in &self.files {
            match file_id(file) {
                Ok(found) if found == *opened => {}
                Ok(_) => return Err(StoreError::gone(file, "another file in its place")),
                Err(error) if error.kind() == io::ErrorKind::NotFound => {
                    return Err(StoreError::gone(file, "that it was deleted"));
                }
                Err(error) => return Err(StoreError::gone(file, &error.to_string())),
            }
        }
        self.files.first().map_or(Ok(()), |(file, _)| self.check_held(file))
    }

    /// Refuses a file that holds another store than before, less of it, or none. Only journals that are written back
    /// change it.
    fn check_held(&self, file: &Path) -> Result<(), StoreError> {
        let mut over = "another file written over it";
        for _ in 0..TRIES {
            let now = stamp(file).map_err(|error| StoreError::gone(file, &error.to_string()))?;
            let mut known = self.known.lock().unwrap_or_else(PoisonError::into_inner);
            if now == known.stamp {
                return Ok(());
            }
            match (&known.alone, Alone::of(file)) {
                (Alone::Store(before), Alone::Store(found)) if !before.precedes(&found) => {
                    over = "another store, or an older state of it, written over it";
                }
                (Alone::Store(_), Alone::Nameless) => over = "another file written over it",
                // Who reads meanwhile keeps a journal from being written back as a whole.
                (Alone::Store(_), Alone::Unreadable) => return Ok(()),
                (_, alone) => {
                    *known = Known { stamp: now, alone };
                    return Ok(());
                }
            }
            drop(known);
            sleep(BETWEEN_TRIES);
        }
        Err(StoreError::gone(file, over))
    }
}

pub(crate) fn stamp(file: &Path) -> io::Result<Stamp> {
    file.metadata().map(|found| (found.modified().ok(), found.len()))
}

/// Device and number of a file.
#[cfg(unix)]
fn file_id(file: &Path) -> io::Result<FileId> {
    use std::os::unix::fs::MetadataExt;
    file.metadata().map(|found| (found.dev(), found.ino()))
}

/// Elsewhere an open database can't be deleted or replaced; that it is there is enough.
#[cfg(not(unix))]
fn file_id(file: &Path) -> io::Result<FileId> {
    file.metadata().map(|_| (0, 0))
}
