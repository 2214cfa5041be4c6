//! Records as JSON.

use crate::disk::files::{read, write_whole_with};
use crate::disk::json::unreadable;
use crate::error::DataError;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::io::{BufWriter, Write};
use std::path::Path;

/// A record that [`write_json`] has written.
pub(crate) fn read_json<T: DeserializeOwned>(file: &Path) -> Result<T, DataError> {
    let record = serde_json::from_slice(&read(file)?);
    record.map_err(|error| unreadable(file, "a record of `ralf label`", &error))
}

/// Writes a record, whole or not at all. It is put into words while it is written: that of a long run has megabytes.
pub(crate) fn write_json<T: Serialize>(file: &Path, value: &T) -> Result<(), DataError> {
    write_whole_with(file, |out| {
        let mut out = BufWriter::new(out);
        serde_json::to_writer_pretty(&mut out, value)?;
        out.write_all(b"\n")?;
        out.flush()
    })
}
