//! Sequences of which a part is missing without which nothing of them can be read.

use crate::error::DataError;
use std::path::{Path, PathBuf};

/// A sequence that has lost what tells its sensors or its scans.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Incomplete {
    /// The sequence's name.
    pub name: String,
    /// The file or folder that isn't there, as the sequence's folder would hold it.
    pub missing: &'static str,
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
            Some(missing) => {
                let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
                incomplete.push(Incomplete { name, missing });
            }
        }
    }
    (whole, incomplete)
}

/// The error where no sequence of a folder is whole.
pub(crate) fn none_whole(path: &Path, expected: String, incomplete: &[Incomplete]) -> DataError {
    let found = match incomplete.first() {
        Some(Incomplete { name, missing }) => format!("none: {name} is without {missing}"),
        None => "none".to_owned(),
    };
    DataError::content(path, "folders", expected, found)
}
