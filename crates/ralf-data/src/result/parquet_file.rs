//! Writing `plausibility.parquet`.

use super::{Columns, FileRecord, ScanTable};
use crate::disk::files::beside;
use crate::error::DataError;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Rows are written in groups of at least this many.
const GROUP_ROWS: usize = 1 << 17;

/// Writes the tables of a sequence, in the order (radar, scan), as one file that appears whole or not at all.
pub struct PlausibilityWriter {
    file: PathBuf,
    writer: SerializedFileWriter<HashedFile>,
    group: Group,
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

/// Rows that are still to be written.
#[derive(Default)]
struct Group {
    radar: Vec<ByteArray>,
    scan: Vec<i32>,
    point: Vec<i32>,
    t_ns: Vec<i64>,
    decimals: Vec<Vec<f32>>,
    label: Vec<i32>,
    flags: Vec<i32>,
    semantic: Vec<Option<i32>>,
}

impl PlausibilityWriter {
    /// Begins the file. Its place stays untouched until [`Self::finish`].
    pub fn create(file: &Path, columns: &Columns) -> Result<Self, DataError> {
        let refused = |error| written(file, error);
        let schema = Arc::new(schema(columns).map_err(refused)?);
        let compression = Compression::ZSTD(ZstdLevel::try_new(3).map_err(refused)?);
        let properties = WriterProperties::builder().set_compression(compression).build();
        if let Some(folder) = file.parent() {
            std::fs::create_dir_all(folder).map_err(DataError::io(folder))?;
        }
        let open = File::create(beside(file)).map_err(DataError::io(file))?;
        let hashed = HashedFile { file: open, hasher: blake3::Hasher::new(), bytes: 0 };
        let writer = SerializedFileWriter::new(hashed, schema, Arc::new(properties)).map_err(refused)?;
        Ok(Self { file: file.to_owned(), writer, group: Group::new(columns) })
    }

    /// Adds a scan's rows.
    pub fn append(&mut self, radar: &str, scan: usize, table: &ScanTable) -> Result<(), DataError> {
        self.group.append(radar, scan, table);
        if self.group.scan.len() >= GROUP_ROWS { self.flush() } else { Ok(()) }
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
        if self.group.scan.is_empty() {
            return Ok(());
        }
        let mut group = self.writer.next_row_group().map_err(|error| written(&self.file, error))?;
        self.group.write(&mut group).map_err(|error| written(&self.file, error))?;
        group.close().map_err(|error| written(&self.file, error))?;
        self.group.clear();
        Ok(())
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

/// The schema of docs/formats.md, section 2.
fn schema(columns: &Columns) -> Result<Type, ParquetError> {
    let unsigned = |bit_width| Some(LogicalType::integer(bit_width, false));
    let mut fields = vec![
        field("radar", Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::REQUIRED)?,
        field("scan", Physical::INT32, unsigned(32), Repetition::REQUIRED)?,
        field("point", Physical::INT32, unsigned(32), Repetition::REQUIRED)?,
        field("t_ns", Physical::INT64, None, Repetition::REQUIRED)?,
    ];
    for name in columns.names() {
        fields.push(field(name, Physical::FLOAT, None, Repetition::OPTIONAL)?);
    }
    fields.push(field("label", Physical::INT32, unsigned(8), Repetition::REQUIRED)?);
    fields.push(field("flags", Physical::INT32, unsigned(16), Repetition::REQUIRED)?);
    fields.push(field("semantic", Physical::INT32, unsigned(16), Repetition::OPTIONAL)?);
    Type::group_type_builder("plausibility").with_fields(fields).build()
}

/// A column of a schema.
pub(crate) fn field(
    name: &str,
    physical: Physical,
    logical: Option<LogicalType>,
    repetition: Repetition,
) -> Result<Arc<Type>, ParquetError> {
    let builder = Type::primitive_type_builder(name, physical);
    builder.with_logical_type(logical).with_repetition(repetition).build().map(Arc::new)
}

impl Group {
    fn new(columns: &Columns) -> Self {
        Self { decimals: vec![Vec::new(); columns.count()], ..Self::default() }
    }

    fn append(&mut self, radar: &str, scan: usize, table: &ScanTable) {
        let rows = table.len();
        self.radar.extend(std::iter::repeat_n(ByteArray::from(radar), rows));
        self.scan.extend(std::iter::repeat_n(scan as i32, rows));
        self.point.extend(0..rows as i32);
        self.t_ns.extend(std::iter::repeat_n(table.t_ns, rows));
        for (all, column) in self.decimals.iter_mut().zip(&table.decimals) {
            all.extend_from_slice(column);
        }
        self.label.extend(table.label.iter().copied().map(i32::from));
        self.flags.extend(table.flags.iter().copied().map(i32::from));
        self.semantic.extend(table.semantic.iter().map(|class| class.map(i32::from)));
    }

    fn write(&self, group: &mut SerializedRowGroupWriter<HashedFile>) -> Result<(), ParquetError> {
        write_column::<ByteArrayType, _>(group, &self.radar, None)?;
        write_column::<Int32Type, _>(group, &self.scan, None)?;
        write_column::<Int32Type, _>(group, &self.point, None)?;
        write_column::<Int64Type, _>(group, &self.t_ns, None)?;
        for column in &self.decimals {
            let present: Vec<f32> = column.iter().copied().filter(|value| value.is_finite()).collect();
            let levels: Vec<i16> = column.iter().map(|value| i16::from(value.is_finite())).collect();
            write_column::<FloatType, _>(group, &present, Some(&levels))?;
        }
        write_column::<Int32Type, _>(group, &self.label, None)?;
        write_column::<Int32Type, _>(group, &self.flags, None)?;
        let present: Vec<i32> = self.semantic.iter().flatten().copied().collect();
        let levels: Vec<i16> = self.semantic.iter().map(|class| i16::from(class.is_some())).collect();
        write_column::<Int32Type, _>(group, &present, Some(&levels))
    }

    fn clear(&mut self) {
        let decimals = std::mem::take(&mut self.decimals);
        *self = Self::default();
        self.decimals = decimals;
        self.decimals.iter_mut().for_each(Vec::clear);
    }
}

/// Writes the next column of a row group; `levels` say of each row whether it has a value.
pub(crate) fn write_column<T: DataType, W: Write + Send>(
    group: &mut SerializedRowGroupWriter<W>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let none_left = || ParquetError::General("more columns than the schema has".into());
    let mut column = group.next_column()?.ok_or_else(none_left)?;
    column.typed::<T>().write_batch(values, levels, None)?;
    column.close()
}
