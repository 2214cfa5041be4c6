//! Parquet files that others made: columns by name, whatever type of number they are stored in.

use crate::disk::files;
use crate::disk::guarded::guarded;
use crate::error::DataError;
use parquet::basic::{Compression, ConvertedType, LogicalType, TimeUnit, Type as Physical};
use parquet::column::reader::{ColumnReaderImpl, get_typed_column_reader};
use parquet::data_type::{ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, RowGroupReader, SerializedFileReader};
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The longest text of a table, bytes: a small file may give each of its rows the same.
const LONGEST_TEXT: usize = 1024;
/// Values that are decoded at once, so that a claim of many takes no memory for them.
const BATCH: usize = 1 << 16;

/// A file, opened.
pub(crate) struct ParquetTable {
    file: PathBuf,
    reader: SerializedFileReader<File>,
    rows: usize,
}

impl ParquetTable {
    /// Opens a file of at most so many rows, and reads what it says of its columns. A small file may hold any number of
    /// rows that are alike.
    pub(crate) fn open(file: &Path, most_rows: usize) -> Result<Self, DataError> {
        let open = files::open(file)?;
        let reader = guarded(file, "content", "a Parquet file", || SerializedFileReader::new(open))?;
        let rows = reader.metadata().file_metadata().num_rows();
        let within = usize::try_from(rows).ok().filter(|rows| *rows <= most_rows);
        let expected = format!("at most {most_rows} rows");
        let rows = within.ok_or_else(|| DataError::content(file, "rows", expected, rows.to_string()))?;
        Ok(Self { file: file.to_owned(), reader, rows })
    }

    /// Whether there is a column of this name.
    pub(crate) fn has(&self, column: &str) -> bool {
        self.place(column).is_some()
    }

    /// A column of numbers; absent values are not a number.
    pub(crate) fn numbers(&self, column: &str) -> Result<Vec<f64>, DataError> {
        let absent = f64::NAN;
        match self.physical(column)? {
            Physical::INT32 => self.values::<Int32Type, _>(column, |value| f64::from(*value), absent),
            Physical::INT64 => self.values::<Int64Type, _>(column, |value| *value as f64, absent),
            Physical::FLOAT => self.values::<FloatType, _>(column, |value| f64::from(*value), absent),
            Physical::DOUBLE => self.values::<DoubleType, _>(column, |value| *value, absent),
            other => Err(self.error(column, "numbers", other.to_string())),
        }
    }

    /// The same as float32, which is what measurements are kept in.
    pub(crate) fn floats(&self, column: &str) -> Result<Vec<f32>, DataError> {
        Ok(self.numbers(column)?.into_iter().map(|value| value as f32).collect())
    }

    /// A column of whole numbers, of which none is absent.
    pub(crate) fn integers(&self, column: &str) -> Result<Vec<i64>, DataError> {
        let values = match self.physical(column)? {
            Physical::INT32 => self.values::<Int32Type, _>(column, |value| Some(i64::from(*value)), None)?,
            Physical::INT64 => self.values::<Int64Type, _>(column, |value| Some(*value), None)?,
            other => return Err(self.error(column, "whole numbers", other.to_string())),
        };
        self.all(column, "a value in every row", values)
    }

    /// A column of times in us, of which none is absent: whole numbers are us, unless the column says another unit. Of
    /// finer ones what is below 1 us is left out.
    pub(crate) fn microseconds(&self, column: &str) -> Result<Vec<i64>, DataError> {
        let times = self.integers(column)?;
        match self.unit(column) {
            TimeUnit::MICROS => Ok(times),
            TimeUnit::NANOS => Ok(times.into_iter().map(|time| time.div_euclid(1000)).collect()),
            TimeUnit::MILLIS => {
                let times = times.into_iter().map(|time| time.checked_mul(1000)).collect();
                self.all(column, "a time in ms of 64 bits of us", times)
            }
        }
    }

    /// The unit that a column says its times are in; us where it says none.
    fn unit(&self, column: &str) -> TimeUnit {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        let Some(found) = self.place(column).map(|place| schema.column(place)) else {
            return TimeUnit::MICROS;
        };
        match (found.logical_type_ref(), found.converted_type()) {
            (Some(LogicalType::Timestamp(found)), _) => found.unit,
            (Some(LogicalType::Time(found)), _) => found.unit,
            (_, ConvertedType::TIMESTAMP_MILLIS | ConvertedType::TIME_MILLIS) => TimeUnit::MILLIS,
            _ => TimeUnit::MICROS,
        }
    }

    /// A column of texts, of which none is absent.
    pub(crate) fn texts(&self, column: &str) -> Result<Vec<Arc<str>>, DataError> {
        let Physical::BYTE_ARRAY = self.physical(column)? else {
            return Err(self.error(column, "texts", self.physical(column)?.to_string()));
        };
        let text = |value: &ByteArray| {
            let text = value.as_utf8().ok().filter(|text| text.len() <= LONGEST_TEXT);
            text.map(Arc::from)
        };
        let values = self.values::<ByteArrayType, _>(column, text, None)?;
        let expected = format!("a text of at most {LONGEST_TEXT} bytes in every row");
        self.all(column, &expected, values)
    }

    fn all<T>(&self, column: &str, expected: &str, values: Vec<Option<T>>) -> Result<Vec<T>, DataError> {
        let found = || format!("none in row {}", values.iter().position(Option::is_none).unwrap_or_default());
        if values.iter().any(Option::is_none) {
            return Err(self.error(column, expected, found()));
        }
        Ok(values.into_iter().flatten().collect())
    }

    fn place(&self, column: &str) -> Option<usize> {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        schema.columns().iter().position(|found| found.name() == column && found.max_rep_level() == 0)
    }

    fn physical(&self, column: &str) -> Result<Physical, DataError> {
        let schema = self.reader.metadata().file_metadata().schema_descr();
        self.place(column).map(|place| schema.column(place).physical_type()).ok_or_else(|| {
            let found: Vec<&str> = schema.columns().iter().map(|column| column.name()).collect();
            DataError::content(&self.file, "columns", format!("a column `{column}`"), found.join(", "))
        })
    }

    /// The values of a column in all row groups.
    fn values<T: DataType, V: Clone>(
        &self,
        column: &str,
        value: impl Fn(&T::T) -> V,
        absent: V,
    ) -> Result<Vec<V>, DataError> {
        let Some(place) = self.place(column) else { return Ok(Vec::new()) };
        self.check_compression(column, place)?;
        let read = || {
            let mut found = Vec::new();
            for group in 0..self.reader.num_row_groups() {
                let group = self.reader.get_row_group(group)?;
                read_group::<T, V>(group.as_ref(), place, &value, &absent, &mut found, self.rows)?;
            }
            Ok::<_, ParquetError>(found)
        };
        let found = guarded(&self.file, column, "values", read)?;
        if found.len() == self.rows {
            return Ok(found);
        }
        Err(self.error(column, &format!("{} rows", self.rows), found.len().to_string()))
    }

    /// Refuses a column that is compressed by what isn't read here.
    fn check_compression(&self, column: &str, place: usize) -> Result<(), DataError> {
        use Compression::{GZIP, LZ4, LZ4_RAW, SNAPPY, UNCOMPRESSED, ZSTD};
        let groups = self.reader.metadata().row_groups().iter();
        let mut columns = groups.filter_map(|group| group.columns().get(place));
        let is_read =
            |found: Compression| matches!(found, UNCOMPRESSED | SNAPPY | GZIP(_) | LZ4 | LZ4_RAW | ZSTD(_));
        match columns.find(|found| !is_read(found.compression())) {
            Some(found) => {
                let codec = found.compression().to_string();
                let name = codec.split('(').next().unwrap_or_default();
                let expected = "values that are compressed by Snappy, gzip, LZ4 or zstd, or not at all";
                Err(self.error(
                    column,
                    expected,
                    format!("some that are compressed by {name}, which isn't read"),
                ))
            }
            None => Ok(()),
        }
    }

    fn error(&self, column: &str, expected: &str, found: String) -> DataError {
        DataError::content(&self.file, column, expected, found)
    }
}

/// The values of the column at `place` of a row group are put behind those in `found`, of which there may be `most`.
pub(crate) fn read_group<T: DataType, V: Clone>(
    group: &dyn RowGroupReader,
    place: usize,
    value: &impl Fn(&T::T) -> V,
    absent: &V,
    found: &mut Vec<V>,
    most: usize,
) -> Result<(), ParquetError> {
    // Values of this level of definition are there.
    let present = group.metadata().schema_descr().column(place).max_def_level();
    let mut reader: ColumnReaderImpl<T> = get_typed_column_reader(group.get_column_reader(place)?);
    loop {
        let (mut values, mut levels) = (Vec::new(), Vec::new());
        let (records, _, _) =
            reader.read_records(BATCH, (present > 0).then_some(&mut levels), None, &mut values)?;
        if records == 0 || found.len() > most {
            return Ok(());
        }
        if present == 0 {
            found.extend(values.iter().map(value));
            continue;
        }
        let mut values = values.iter();
        let of_level = |level: &i16| {
            let there = if *level == present { values.next() } else { None };
            there.map_or_else(|| absent.clone(), value)
        };
        found.extend(levels.iter().map(of_level));
    }
}
