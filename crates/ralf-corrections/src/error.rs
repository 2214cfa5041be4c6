//! What can be wrong with a store, or with what is asked of it.

use rusqlite::ErrorCode;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a store could not be opened, read or written.
#[derive(Debug, Error)]
pub enum StoreError {
    /// Another program writes for longer than we wait.
    #[error("{}: expected to write, found it locked by another program for {seconds} s; try again", file.display())]
    Locked {
        /// The store.
        file: PathBuf,
        /// How long was waited.
        seconds: u64,
    },
    /// The file or its folder can't be written.
    #[error("{}: expected a file that can be written, found one that can only be read", file.display())]
    ReadOnly {
        /// The store.
        file: PathBuf,
    },
    /// The file that was opened is not the one that lies there now: what is written to it nobody will ever read.
    #[error(
        "{}: expected the file that was opened, found {found}; nothing is saved any more: put it back, or start again",
        file.display()
    )]
    Gone {
        /// The store's file, or its journal.
        file: PathBuf,
        /// What became of it.
        found: String,
    },
    /// The file holds something else than it should.
    #[error("{}: {place}: expected {expected}, found {found}", file.display())]
    Content {
        /// The store.
        file: PathBuf,
        /// Table, setting or scan.
        place: String,
        /// What it should hold.
        expected: String,
        /// What is there.
        found: String,
    },
    /// What was asked for makes no sense, whatever the store holds.
    #[error("{place}: expected {expected}, found {found}")]
    Request {
        /// Part of what was asked for.
        place: String,
        /// What it should be.
        expected: String,
        /// What it is.
        found: String,
    },
    /// The system refused.
    #[error("{}: {error}", file.display())]
    Io {
        /// The store.
        file: PathBuf,
        /// What it said.
        error: io::Error,
    },
    /// The database refused otherwise.
    #[error("{}: {error}", file.display())]
    Database {
        /// The store.
        file: PathBuf,
        /// What it said.
        error: rusqlite::Error,
    },
}

/// How long a write waits for another program's.
pub(crate) const WAIT_SECONDS: u64 = 5;

/// For `map_err`: what SQLite said, of this file.
pub(crate) fn told(file: &Path) -> impl Fn(rusqlite::Error) -> StoreError {
    let file = file.to_owned();
    move |error| {
        let file = file.clone();
        match error.sqlite_error_code() {
            Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked) => {
                StoreError::Locked { file, seconds: WAIT_SECONDS }
            }
            Some(ErrorCode::ReadOnly | ErrorCode::CannotOpen | ErrorCode::PermissionDenied) => {
                StoreError::ReadOnly { file }
            }
            Some(ErrorCode::NotADatabase | ErrorCode::DatabaseCorrupt) => StoreError::Content {
                file,
                place: "file".into(),
                expected: "a whole SQLite database of corrections".into(),
                found: "another file, or a damaged one".into(),
            },
            _ => StoreError::Database { file, error },
        }
    }
}

impl StoreError {
    /// The store, where it is one that is wrong and not what was asked for.
    pub fn file(&self) -> Option<&Path> {
        match self {
            Self::Locked { file, .. }
            | Self::ReadOnly { file }
            | Self::Gone { file, .. }
            | Self::Content { file, .. }
            | Self::Io { file, .. }
            | Self::Database { file, .. } => Some(file),
            Self::Request { .. } => None,
        }
    }

    pub(crate) fn gone(file: &Path, found: &str) -> Self {
        Self::Gone { file: file.to_owned(), found: found.to_owned() }
    }

    /// For `map_err`: what the system said of a file.
    pub(crate) fn io(file: &Path) -> impl FnOnce(io::Error) -> Self {
        move |error| match error.kind() {
            io::ErrorKind::PermissionDenied | io::ErrorKind::ReadOnlyFilesystem => {
                Self::ReadOnly { file: file.to_owned() }
            }
            _ => Self::Io { file: file.to_owned(), error },
        }
    }

    pub(crate) fn content(
        file: &Path,
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        let (place, expected, found) = (place.into(), expected.into(), found.into());
        Self::Content { file: file.to_owned(), place, expected, found }
    }

    pub(crate) fn request(
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        Self::Request { place: place.into(), expected: expected.into(), found: found.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rusqlite::{Connection, OpenFlags};

    #[test]
    fn a_file_that_can_only_be_read_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("corrections.sqlite");
        Connection::open(&file).unwrap().execute_batch("CREATE TABLE scan (id INTEGER)").unwrap();
        let connection = Connection::open_with_flags(&file, OpenFlags::SQLITE_OPEN_READ_ONLY).unwrap();
        let error = connection.execute_batch("DROP TABLE scan").map_err(told(&file)).unwrap_err();
        assert!(matches!(error, StoreError::ReadOnly { .. }), "{error}");
        assert!(
            error
                .to_string()
                .ends_with("expected a file that can be written, found one that can only be read")
        );
    }
}
