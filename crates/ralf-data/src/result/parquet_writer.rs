//! Writing `plausibility.parquet`.

use super::parquet_columns::{EncodedGroup, GROUP_ROWS, Layout};
use super::schema::{SCAN, Schema};
use super::{FileRecord, RadarScanKey, Table, Values};
use crate::disk::files::{beside, create_new};
use crate::error::DataError;
use parquet::errors::ParquetError;
use parquet::file::writer::SerializedFileWriter;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Bytes that are written at a time: hashing fewer takes longer.
const AT_ONCE: usize = 1 << 18;

/// Writes the tables of a sequence, in the order (radar, scan), as one file that appears whole or not at all.
pub struct PlausibilityWriter {
    file: PathBuf,
    writer: SerializedFileWriter<BufWriter<HashedFile>>,
    layout: Arc<Layout>,
    rows: RowGroup,
}

/// Rows of scans that follow each other, which are to be written together.
pub(crate) struct RowGroup {
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

impl RowGroup {
    /// No rows, and room for so many.
    pub(crate) fn with_room(schema: &Arc<Schema>, rows: usize) -> Self {
        let table = Table::with_room(schema.clone(), rows);
        Self { rows: table, radars: Vec::with_capacity(rows), scans: Vec::with_capacity(rows) }
    }

    /// Adds a scan's rows.
    ///
    /// # Errors
    /// A table with other columns.
    pub(crate) fn append(&mut self, key: &RadarScanKey, table: &Table) -> Result<(), DataError> {
        self.rows.append(table)?;
        self.radars.extend(std::iter::repeat_n(key.radar.clone(), table.len()));
        self.scans.extend(std::iter::repeat_n(key.scan as u32, table.len()));
        Ok(())
    }

    /// The bytes that these rows are in a file of this layout.
    pub(crate) fn encode(self, layout: &Layout) -> Result<EncodedGroup, ParquetError> {
        let scan = [Values::Text(self.radars), Values::U32(self.scans)];
        layout.encode(scan.iter().chain(self.rows.columns().map(|(_, values)| values)))
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
        let layout = Layout::new("plausibility", SCAN.iter().chain(schema.columns()));
        let layout = layout.map_err(|error| written(file, error))?;
        let writer = layout.begin(BufWriter::with_capacity(AT_ONCE, hashed));
        let writer = writer.map_err(|error| written(file, error))?;
        let rows = RowGroup::with_room(schema, 0);
        Ok(Self { file: file.to_owned(), writer, layout: Arc::new(layout), rows })
    }

    /// Adds a scan's rows.
    ///
    /// # Errors
    /// A table with other columns, or what the system refuses.
    pub fn append(&mut self, key: &RadarScanKey, table: &Table) -> Result<(), DataError> {
        self.rows.append(key, table)?;
        if self.rows.rows.len() >= GROUP_ROWS { self.flush() } else { Ok(()) }
    }

    /// How the file's columns are stored, for those who encode whole groups of it ([`Self::append_group`]).
    pub(crate) fn layout(&self) -> &Arc<Layout> {
        &self.layout
    }

    /// Adds a group of rows; those that were added before are written first.
    pub(crate) fn append_group(&mut self, group: EncodedGroup) -> Result<(), DataError> {
        self.flush()?;
        group.append_to(&mut self.writer).map_err(|error| written(&self.file, error))
    }

    /// Ends the file and puts it in its place. Returns its size and hash.
    pub fn finish(mut self) -> Result<FileRecord, DataError> {
        self.flush()?;
        self.writer.finish().map_err(|error| written(&self.file, error))?;
        self.writer.inner_mut().flush().map_err(DataError::io(&self.file))?;
        let open = self.writer.inner().get_ref();
        open.file.sync_all().map_err(DataError::io(&self.file))?;
        let record = FileRecord { bytes: open.bytes, blake3: open.hasher.finalize().to_hex().to_string() };
        std::fs::rename(beside(&self.file), &self.file).map_err(DataError::io(&self.file))?;
        Ok(record)
    }

    fn flush(&mut self) -> Result<(), DataError> {
        if self.rows.rows.is_empty() {
            return Ok(());
        }
        let empty = RowGroup::with_room(self.rows.rows.schema(), 0);
        let group = std::mem::replace(&mut self.rows, empty).encode(&self.layout);
        let group = group.and_then(|group| group.append_to(&mut self.writer));
        group.map_err(|error| written(&self.file, error))
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
