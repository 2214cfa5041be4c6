//! Writing `plausibility.parquet`.

use super::parquet_columns::{GROUP_ROWS, begin, write_values};
use super::schema::{SCAN, Schema};
use super::{FileRecord, RadarScanKey, Table, Values};
use crate::disk::files::{beside, create_new};
use crate::error::DataError;
use parquet::errors::ParquetError;
use parquet::file::writer::SerializedFileWriter;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Writes the tables of a sequence, in the order (radar, scan), as one file that appears whole or not at all.
pub struct PlausibilityWriter {
    file: PathBuf,
    writer: SerializedFileWriter<HashedFile>,
    /// Rows that are still to be written, and the scans that they belong to.
    rows: Table,
    radars: Vec<Arc<str>>,
    scans: Vec<u32>,
}

/// A file that is hashed as it is written.
struct HashedFile {
    file: File,
    hasher: blake3::Hasher,
    bytes: u64,
}

impl Write for HashedFile {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        let written = self.file.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        self.bytes += written as u64;
        Ok(written)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        self.file.flush()
    }
}

impl PlausibilityWriter {
    /// Begins the file. Its place stays untouched until [`Self::finish`].
    pub fn create(file: &Path, schema: &Arc<Schema>) -> Result<Self, DataError> {
        if let Some(folder) = file.parent() {
            std::fs::create_dir_all(folder).map_err(DataError::io(folder))?;
        }
        let open = create_new(&beside(file)).map_err(DataError::io(file))?;
        let hashed = HashedFile { file: open, hasher: blake3::Hasher::new(), bytes: 0 };
        let columns = SCAN.iter().chain(schema.columns());
        let writer = begin(hashed, "plausibility", columns).map_err(|error| written(file, error))?;
        let (rows, file) = (Table::empty(schema.clone()), file.to_owned());
        Ok(Self { file, writer, rows, radars: Vec::new(), scans: Vec::new() })
    }

    /// Adds a scan's rows.
    ///
    /// # Errors
    /// A table with other columns, or what the system refuses.
    pub fn append(&mut self, key: &RadarScanKey, table: &Table) -> Result<(), DataError> {
        self.rows.append(table)?;
        self.radars.extend(std::iter::repeat_n(key.radar.clone(), table.len()));
        self.scans.extend(std::iter::repeat_n(key.scan as u32, table.len()));
        if self.rows.len() >= GROUP_ROWS { self.flush() } else { Ok(()) }
    }

    /// Ends the file and puts it in its place. Returns its size and hash.
    pub fn finish(mut self) -> Result<FileRecord, DataError> {
        self.flush()?;
        self.writer.finish().map_err(|error| written(&self.file, error))?;
        let open = self.writer.inner();
        open.file.sync_all().map_err(DataError::io(&self.file))?;
        let record = FileRecord { bytes: open.bytes, blake3: open.hasher.finalize().to_hex().to_string() };
        std::fs::rename(beside(&self.file), &self.file).map_err(DataError::io(&self.file))?;
        Ok(record)
    }

    fn flush(&mut self) -> Result<(), DataError> {
        if self.rows.is_empty() {
            return Ok(());
        }
        self.write_group().map_err(|error| written(&self.file, error))?;
        self.rows.clear();
        Ok(())
    }

    fn write_group(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        write_values(&mut group, &Values::Text(std::mem::take(&mut self.radars)))?;
        write_values(&mut group, &Values::U32(std::mem::take(&mut self.scans)))?;
        for (_, values) in self.rows.columns() {
            write_values(&mut group, values)?;
        }
        group.close().map(drop)
    }
}

impl Drop for PlausibilityWriter {
    /// A half-written file is of no use to anyone. Of a finished one nothing is left beside its place.
    fn drop(&mut self) {
        let _ = std::fs::remove_file(beside(&self.file));
    }
}

/// The system or the format refused to write `file`.
pub(crate) fn written(file: &Path, error: ParquetError) -> DataError {
    DataError::Io { file: file.to_owned(), error: std::io::Error::other(error) }
}
