//! What can be wrong with a file: every error names the file, the place in it, what was expected and what was found.

use ralf::config::ConfigError;
use ralf::sensors::SourceError;
use ralf_corrections::StoreError;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why something could not be read or written.
#[derive(Debug, Error)]
pub enum DataError {
    /// The system refused.
    #[error("{}: {error}", file.display())]
    Io {
        /// The file or folder.
        file: PathBuf,
        /// What the system said.
        error: std::io::Error,
    },
    /// The file holds something else than it should.
    #[error("{}: {place}: expected {expected}, found {found}", file.display())]
    Content {
        /// The file or folder.
        file: PathBuf,
        /// Line, byte, key or column.
        place: String,
        /// What the format asks for.
        expected: String,
        /// What is there.
        found: String,
    },
    /// The file is as it should be, but doesn't go with what is asked for.
    #[error("{}: {place}: {reason}", file.display())]
    Unsuitable {
        /// The file or folder.
        file: PathBuf,
        /// Part of it.
        place: String,
        /// Why not.
        reason: String,
    },
    /// A sequence was asked for that the recording doesn't hold.
    #[error("no sequence `{name}` in the recording, which holds {known}")]
    UnknownSequence {
        /// The name asked for.
        name: String,
        /// Those that exist.
        known: String,
    },
    /// A measurement was asked for that the sequence doesn't hold.
    #[error("{kind} {sensor} has no measurement {index}")]
    NoMeasurement {
        /// `radar`, `lidar` or `camera`.
        kind: &'static str,
        /// The sensor's place in the rig.
        sensor: usize,
        /// The measurement's place in the sensor's timeline.
        index: usize,
    },
    /// A column was asked for that a table doesn't have.
    #[error("no column `{name}` among {known}")]
    NoColumn {
        /// The name asked for.
        name: String,
        /// Those that exist.
        known: String,
    },
    /// A column is not what it was taken for.
    #[error("column `{name}`: found {found}")]
    WrongColumn {
        /// Its name, or `*` of all.
        name: String,
        /// What there is.
        found: String,
    },
    /// A name in the recording can't be a file's or a folder's where output is written.
    #[error(
        "{kind}: expected a name that a folder can have and that leads nowhere else, found {found}: {name:?}"
    )]
    Name {
        /// What has it.
        kind: String,
        /// The name.
        name: String,
        /// What is wrong with it.
        found: &'static str,
    },
    /// Another process writes to the same place.
    #[error("{}: another run of ralf writes here: wait until it ends, or choose another place", place.display())]
    Busy {
        /// The file or folder.
        place: PathBuf,
    },
    /// Somebody wanted the work to end. What is done is kept, and found again.
    #[error("stopped")]
    Stopped,
    /// The store of corrections.
    #[error(transparent)]
    Corrections(#[from] StoreError),
    /// A measurement could not be read.
    #[error("{sensor}, measurement {index}: {error}")]
    Measurement {
        /// The sensor's name.
        sensor: String,
        /// Its place in the sensor's timeline, from 0.
        index: usize,
        /// Why.
        error: SourceError,
    },
}

impl DataError {
    /// For `map_err`: the system refused to read or write `file`.
    pub fn io(file: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let file = file.into();
        move |error| Self::Io { file, error }
    }

    /// Whether the system lets nobody, or not this user, write there.
    pub(crate) fn is_of_permission(&self) -> bool {
        let kinds = [ErrorKind::PermissionDenied, ErrorKind::ReadOnlyFilesystem];
        matches!(self, Self::Io { error, .. } if kinds.contains(&error.kind()))
    }

    /// Settings that no recording can be read with.
    pub(crate) fn settings(recording: &Path, error: &ConfigError) -> Self {
        let (file, place) = (recording.to_owned(), "settings".to_owned());
        Self::Unsuitable { file, place, reason: error.to_string() }
    }

    /// The file holds something else than it should.
    pub fn content(
        file: &Path,
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        let (place, expected, found) = (place.into(), expected.into(), found.into());
        Self::Content { file: file.to_owned(), place, expected, found }
    }
}

/// The halves of a sentence `expected X, found Y`.
pub(crate) fn expected_and_found(reason: &str) -> (&str, &str) {
    let (expected, found) = reason.split_once(", found ").unwrap_or((reason, "something else"));
    (expected.strip_prefix("expected ").unwrap_or(expected), found)
}
