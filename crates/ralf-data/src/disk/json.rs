//! JSON files that others made.

use crate::disk::files;
use crate::error::DataError;
use ralf::config::in_words;
use ralf_files::Kind;
use serde::de::DeserializeOwned;
use std::path::Path;

/// A file of this content. An error names line and column.
pub(crate) fn read<T: DeserializeOwned>(file: &Path, kind: Kind, expected: &str) -> Result<T, DataError> {
    let text = files::read_text(file, kind)?;
    serde_json::from_str(&text).map_err(|error| unreadable(file, expected, &error))
}

/// What is wrong with a file, and where.
pub(crate) fn unreadable(file: &Path, expected: &str, error: &serde_json::Error) -> DataError {
    let place = format!("line {}, column {}", error.line(), error.column());
    // The parser of a part may say it over several lines.
    let told = in_words(&error.to_string()).split_whitespace().collect::<Vec<_>>().join(" ");
    let found = told.split(" at line ").next().unwrap_or(&told);
    DataError::content(file, place, expected, found)
}
