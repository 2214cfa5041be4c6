//! A Parquet data set, partitioned by sequence as Hive does it: `sequence=NAME/RADAR.parquet`, a row per detection.

use super::Writer;
use super::columns::{Column, Values, table_columns};
use super::labelled::LabelledSequence;
use crate::error::DataError;
use crate::result::{OutFolder, checked, field, write_column, written};
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::fs::{self, File};
use std::path::Path;
use std::sync::Arc;

/// Rows are written in groups of at least this many.
const GROUP_ROWS: usize = 1 << 17;

/// Writes the data set.
pub(super) struct Parquet;

impl Writer for Parquet {
    fn sequence(&mut self, folder: &OutFolder, sequence: &mut LabelledSequence) -> Result<(), DataError> {
        let partition = format!("sequence={}", partition(sequence.name()));
        let folder = folder.folder(&checked("sequence, as a partition's name", &partition)?);
        fs::create_dir_all(folder.path()).map_err(DataError::io(folder.path()))?;
        for (radar, sensor) in sequence.reader.sequence().rig.radars.iter().enumerate() {
            let file = folder.file(&sequence.names.radars[radar].and(".parquet"));
            let mut rows = RadarFile { file: &file, radar: &sensor.name, rows: Vec::new(), writer: None };
            for scan in 0..sequence.scans(radar) {
                let labelled = sequence.scan(radar, scan)?;
                rows.append(table_columns(sequence, &labelled))?;
            }
            rows.finish()?;
        }
        Ok(())
    }
}

/// A value in a folder's name: what is neither a letter, a digit nor one of `-_.` stands as `%` and two hex digits.
fn partition(name: &str) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-_.".contains(&byte);
    name.bytes()
        .map(|byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") })
        .collect()
}

/// The file of one radar; one that never scanned has none.
struct RadarFile<'a> {
    file: &'a Path,
    radar: &'a str,
    /// Rows that are still to be written.
    rows: Vec<Column>,
    writer: Option<SerializedFileWriter<File>>,
}

impl RadarFile<'_> {
    fn append(&mut self, columns: Vec<Column>) -> Result<(), DataError> {
        if self.rows.is_empty() {
            self.rows = columns;
        } else {
            self.rows.iter_mut().zip(columns).for_each(|(all, column)| all.values.append(column.values));
        }
        if self.count() >= GROUP_ROWS { self.flush() } else { Ok(()) }
    }

    /// How many rows are still to be written.
    fn count(&self) -> usize {
        self.rows.first().map_or(0, |column| column.values.len())
    }

    /// Writes a row group. The first one, even without rows, begins the file.
    fn flush(&mut self) -> Result<(), DataError> {
        let refused = |error| written(self.file, error);
        let writer = match &mut self.writer {
            Some(writer) => writer,
            none => {
                let open = File::create(self.file).map_err(DataError::io(self.file))?;
                none.insert(begin(open, &self.rows).map_err(refused)?)
            }
        };
        let group = writer.next_row_group();
        group.and_then(|group| write_group(group, self.radar, &self.rows)).map_err(refused)?;
        self.rows.clear();
        Ok(())
    }

    fn finish(mut self) -> Result<(), DataError> {
        if !self.rows.is_empty() {
            self.flush()?;
        }
        let finished = self.writer.map(|mut writer| writer.finish().map(drop)).transpose();
        finished.map(drop).map_err(|error| written(self.file, error))
    }
}

fn begin(open: File, columns: &[Column]) -> Result<SerializedFileWriter<File>, ParquetError> {
    let mut fields =
        vec![field("radar", Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::REQUIRED)?];
    for Column { name, values } in columns {
        let (physical, logical, repetition) = kind(values);
        fields.push(field(name, physical, logical, repetition)?);
    }
    let schema = Type::group_type_builder("labels").with_fields(fields).build()?;
    let compression = Compression::ZSTD(ZstdLevel::try_new(3)?);
    let properties = WriterProperties::builder().set_compression(compression).build();
    SerializedFileWriter::new(open, Arc::new(schema), Arc::new(properties))
}

/// How a column lies in the file. Whole numbers are never absent.
fn kind(values: &Values) -> (Physical, Option<LogicalType>, Repetition) {
    let unsigned = |bit_width| Some(LogicalType::integer(bit_width, false));
    match values {
        Values::F32(_) => (Physical::FLOAT, None, Repetition::OPTIONAL),
        Values::U16(_) => (Physical::INT32, unsigned(16), Repetition::REQUIRED),
        Values::U32(_) => (Physical::INT32, unsigned(32), Repetition::REQUIRED),
        Values::I64(_) => (Physical::INT64, None, Repetition::REQUIRED),
        Values::Truth(_) => (Physical::BOOLEAN, None, Repetition::OPTIONAL),
    }
}

fn write_group(
    mut group: SerializedRowGroupWriter<File>,
    radar: &str,
    columns: &[Column],
) -> Result<(), ParquetError> {
    let rows = columns.first().map_or(0, |column| column.values.len());
    write_column::<ByteArrayType, _>(&mut group, &vec![ByteArray::from(radar); rows], None)?;
    for column in columns {
        match &column.values {
            Values::F32(values) => {
                let present: Vec<f32> = values.iter().copied().filter(|value| value.is_finite()).collect();
                let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_finite())).collect();
                write_column::<FloatType, _>(&mut group, &present, Some(&levels))?;
            }
            Values::U16(values) => {
                let values: Vec<i32> = values.iter().copied().map(i32::from).collect();
                write_column::<Int32Type, _>(&mut group, &values, None)?;
            }
            Values::U32(values) => {
                let values: Vec<i32> = values.iter().map(|value| value.cast_signed()).collect();
                write_column::<Int32Type, _>(&mut group, &values, None)?;
            }
            Values::I64(values) => write_column::<Int64Type, _>(&mut group, values, None)?,
            Values::Truth(values) => {
                let present: Vec<bool> = values.iter().flatten().copied().collect();
                let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
                write_column::<BoolType, _>(&mut group, &present, Some(&levels))?;
            }
        }
    }
    group.close().map(drop)
}

#[cfg(test)]
mod tests {
    use super::partition;

    #[test]
    fn names_are_escaped_as_in_addresses() {
        for (name, expected) in
            [("00", "00"), ("scene-0061_a.b", "scene-0061_a.b"), ("a b=c%", "a%20b%3Dc%25"), ("é", "%C3%A9")]
        {
            assert_eq!(partition(name), expected);
        }
    }
}
