//! Sequences of which nothing can be read, while others of their recording can.

use crate::error::DataError;
use std::fmt;
use std::path::{Path, PathBuf};

/// A sequence of which nothing can be read.
#[derive(Debug)]
pub struct Incomplete {
    /// The sequence's name.
    pub name: String,
    /// Why not.
    pub lost: Lost,
}

/// Why nothing of a sequence can be read.
#[derive(Debug)]
pub enum Lost {
    /// This file or folder, as the sequence's folder would hold it, isn't there.
    Part(&'static str),
    /// No file of any radar is there.
    Radars,
    /// It was refused.
    Refused(DataError),
}

impl fmt::Display for Lost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Part(missing) => write!(f, "{missing} is missing"),
            Self::Radars => f.write_str("no file of their radars is there"),
            Self::Refused(error) => error.fmt(f),
        }
    }
}

/// The folders of sequences that are whole, in their order, and what the others lack.
pub(crate) fn parted(
    folders: Vec<PathBuf>,
    missing: fn(&Path) -> Option<&'static str>,
) -> (Vec<PathBuf>, Vec<Incomplete>) {
    let (mut whole, mut incomplete) = (Vec::new(), Vec::new());
    for folder in folders {
        match missing(&folder) {
            None => whole.push(folder),
            Some(missing) => incomplete.push(Incomplete { name: named(&folder), lost: Lost::Part(missing) }),
        }
    }
    (whole, incomplete)
}

/// The name of a sequence that is called as its folder.
pub(crate) fn named(folder: &Path) -> String {
    folder.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// The error where no sequence of a folder is whole.
pub(crate) fn none_whole(path: &Path, expected: String, incomplete: &[Incomplete]) -> DataError {
    let found = match incomplete.first() {
        Some(Incomplete { name, lost: Lost::Part(missing) }) => format!("none: {name} is without {missing}"),
        _ => "none".to_owned(),
    };
    DataError::content(path, "folders", expected, found)
}

/// The sequences that lack parts, or the first error by which one was refused.
pub(crate) fn whole(incomplete: Vec<Incomplete>) -> Result<Vec<Incomplete>, DataError> {
    incomplete
        .into_iter()
        .map(|one| match one.lost {
            Lost::Refused(error) => Err(error),
            lost => Ok(Incomplete { lost, ..one }),
        })
        .collect()
}
