//! Records as JSON.

use crate::disk::files::{read, write_whole};
use crate::error::DataError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::path::Path;

/// A record that [`write_json`] has written.
pub(crate) fn read_json<T: DeserializeOwned>(file: &Path) -> Result<T, DataError> {
    serde_json::from_slice(&read(file)?).map_err(|error| {
        let place = format!("line {}, column {}", error.line(), error.column());
        DataError::content(file, place, "a record of `ralf label`", error.to_string())
    })
}

/// Writes a record, whole or not at all.
pub(crate) fn write_json<T: Serialize>(file: &Path, value: &T) -> Result<(), DataError> {
    let mut text = serde_json::to_vec_pretty(value).map_err(|error| DataError::io(file)(error.into()))?;
    text.push(b'\n');
    write_whole(file, &text)
}
