//! What can be wrong with a recording.

use crate::encoding::EncodingError;
use std::io;
use std::path::{Path, PathBuf};
use thiserror::Error;

/// Why a recording, or a message of it, could not be read.
#[derive(Debug, Error)]
pub enum ContainerError {
    /// The system refused.
    #[error("{}: {error}", file.display())]
    Io {
        /// The file or folder.
        file: PathBuf,
        /// What the system said.
        error: io::Error,
    },
    /// The file holds something else than it should.
    #[error("{}: {place}: expected {expected}, found {found}", file.display())]
    Content {
        /// The file or folder.
        file: PathBuf,
        /// Where in it.
        place: String,
        /// What the format asks for.
        expected: String,
        /// What is there.
        found: String,
    },
}

impl ContainerError {
    pub(super) fn io(file: &Path) -> impl FnOnce(io::Error) -> Self {
        let file = file.to_owned();
        move |error| Self::Io { file, error }
    }

    pub(super) fn content(
        file: &Path,
        place: impl Into<String>,
        expected: impl Into<String>,
        found: impl Into<String>,
    ) -> Self {
        let (place, expected, found) = (place.into(), expected.into(), found.into());
        Self::Content { file: file.to_owned(), place, expected, found }
    }

    /// Something wrong inside a part of a file, such as a chunk.
    pub(super) fn inside(file: &Path, part: &str, error: EncodingError) -> Self {
        Self::content(file, format!("{part}, byte {}", error.position), error.expected, error.found)
    }
}

/// Why a file is read no further.
#[derive(Debug, Error)]
pub(super) enum Stop {
    /// The system refused: nothing is known of the rest.
    #[error("{0}")]
    Io(io::Error),
    /// What is there can't be read by this program: it would be wrong to go on without it.
    #[error("{0}")]
    Refused(EncodingError),
    /// The file ends before what was begun does: what was found up to here is good.
    #[error("{0}")]
    Cut(EncodingError),
    /// The file is damaged here: what was found up to here is good.
    #[error("{0}")]
    Damaged(EncodingError),
}

impl From<EncodingError> for Stop {
    fn from(error: EncodingError) -> Self {
        Self::Damaged(error)
    }
}
