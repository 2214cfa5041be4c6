//! Whether the file that is open is still the one that lies there. A file that was deleted or replaced takes
//! every edit, and nobody ever reads it again.

use crate::error::StoreError;
use ralf_files::database::log;
use std::io;
use std::path::{Path, PathBuf};

/// The files of an open store, as they were when it was opened.
#[derive(Debug, Clone)]
pub(crate) struct Identity {
    files: Vec<(PathBuf, FileId)>,
}

type FileId = (u64, u64);

impl Identity {
    /// The store's file, and its journal, which lies there as long as anybody has the store open; some file
    /// systems know none.
    pub(crate) fn of_store(file: &Path) -> Result<Self, StoreError> {
        let id = file_id(file).map_err(|_| StoreError::gone(file, "that it was deleted"))?;
        let mut files = vec![(file.to_owned(), id)];
        let log = log(file);
        if let Ok(id) = file_id(&log) {
            files.push((log, id));
        }
        Ok(Self { files })
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
        Ok(())
    }
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
