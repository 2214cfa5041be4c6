//! A table's columns by name, whatever width and order their numbers are stored in.

use super::guarded;
use crate::disk::number::Number;
use crate::error::DataError;
use hdf5_reader::error::ByteOrder;
use hdf5_reader::{CompoundField, Dataset, Datatype, StringSize, VarLenKind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A table in memory: rows of records.
pub(crate) struct Table {
    file: PathBuf,
    name: String,
    dataset: Dataset,
    fields: Vec<CompoundField>,
    row_bytes: usize,
    bytes: Vec<u8>,
}

/// A column, and where it lies in a row.
struct Column<'a> {
    field: &'a CompoundField,
    bytes: usize,
}

/// A number as it is stored.
#[derive(Clone, Copy)]
struct Stored {
    number: Number,
    order: ByteOrder,
}

impl Table {
    pub(super) fn read(file: &Path, name: &str, dataset: Dataset) -> Result<Self, DataError> {
        let Datatype::Compound { fields, .. } = dataset.dtype().clone() else {
            return Err(DataError::content(file, name, "a table", format!("{:?}", dataset.dtype())));
        };
        if let [_] = dataset.shape() {
            let expected = "a table whose size the file can hold";
            let row_bytes = guarded(file, name, expected, || dataset.raw_element_size())?;
            let bytes = guarded(file, name, expected, || dataset.read_raw_bytes())?;
            let (file, name) = (file.to_owned(), name.to_owned());
            return Ok(Self { file, name, dataset, fields, row_bytes: row_bytes.max(1), bytes });
        }
        let found = format!("{} dimensions", dataset.shape().len());
        Err(DataError::content(file, name, "one dimension", found))
    }

    /// How many rows there are.
    pub(crate) fn rows(&self) -> usize {
        self.bytes.len() / self.row_bytes
    }

    /// Whether there is a column of this name.
    pub(crate) fn has(&self, column: &str) -> bool {
        self.fields.iter().any(|field| field.name == column)
    }

    /// A column of numbers: whole ones, floats, or truth values (0 and 1).
    pub(crate) fn numbers(&self, column: &str) -> Result<Vec<f64>, DataError> {
        let found = self.column(column)?;
        let number = self.number(&found)?;
        self.values(&found, |(_, bytes)| Ok(number.read(bytes, Number::value)))
    }

    /// The same as float32, which is what measurements are kept in.
    pub(crate) fn floats(&self, column: &str) -> Result<Vec<f32>, DataError> {
        Ok(self.numbers(column)?.into_iter().map(|value| value as f32).collect())
    }

    /// A column of whole numbers, which may be stored as floats.
    pub(crate) fn integers(&self, column: &str) -> Result<Vec<i64>, DataError> {
        let found = self.column(column)?;
        let number = self.number(&found)?;
        self.values(&found, |(row, bytes)| {
            let expected = "a whole number of at most 63 bits";
            number
                .read(bytes, Number::integer)
                .map_err(|found| self.error(&format!("{column}, row {row}"), expected, found))
        })
    }

    /// A column of texts; those that follow each other and are alike share their memory.
    pub(crate) fn texts(&self, column: &str) -> Result<Vec<Arc<str>>, DataError> {
        let found = self.column(column)?;
        let variable = match &found.field.datatype {
            Datatype::String { size: StringSize::Fixed(_), .. } => false,
            Datatype::String { size: StringSize::Variable, .. }
            | Datatype::VarLen { kind: VarLenKind::String, .. } => true,
            other => return Err(self.error(column, "texts", format!("{other:?}"))),
        };
        let mut last: Option<Arc<str>> = None;
        self.values(&found, |(row, bytes)| {
            let place = format!("{column}, row {row}");
            let stored = if variable { self.stored_elsewhere(&place, bytes)? } else { bytes.to_vec() };
            let end = stored.iter().position(|byte| *byte == 0).unwrap_or(stored.len());
            let text = str::from_utf8(&stored[..end])
                .map_err(|_| self.error(&place, "UTF-8 text", "other bytes".to_owned()))?;
            let text = text.trim_end_matches(' ');
            let same = last.clone().filter(|last| last.as_ref() == text);
            let text = same.unwrap_or_else(|| text.into());
            last = Some(text.clone());
            Ok(text)
        })
    }

    /// The names of the columns, for people.
    fn columns(&self) -> String {
        self.fields.iter().map(|field| field.name.as_str()).collect::<Vec<_>>().join(", ")
    }

    fn column(&self, name: &str) -> Result<Column<'_>, DataError> {
        let field = self.fields.iter().find(|field| field.name == name);
        let field =
            field.ok_or_else(|| self.error("columns", &format!("a column `{name}`"), self.columns()))?;
        let bytes = match &field.datatype {
            Datatype::Enum { base, .. } => size(base),
            Datatype::VarLen { .. } | Datatype::String { size: StringSize::Variable, .. } => {
                Some(self.dataset.vlen_reference_size())
            }
            other => size(other),
        };
        let within = bytes.filter(|bytes| field.byte_offset as usize + bytes <= self.row_bytes);
        let found = || format!("{:?}", field.datatype);
        let bytes = within.ok_or_else(|| self.error(name, "numbers or texts in a row", found()))?;
        Ok(Column { field, bytes })
    }

    /// One value per row of a column.
    fn values<T>(
        &self,
        column: &Column,
        value: impl FnMut((usize, &[u8])) -> Result<T, DataError>,
    ) -> Result<Vec<T>, DataError>
    where
        T: Clone,
    {
        let first = column.field.byte_offset as usize;
        let rows = self.bytes.chunks_exact(self.row_bytes).map(|row| &row[first..first + column.bytes]);
        rows.enumerate().map(value).collect()
    }

    /// How the numbers of a column are stored: whole ones may have any size, for HDF5 knows no usual ones.
    fn number(&self, column: &Column) -> Result<Stored, DataError> {
        let datatype = match &column.field.datatype {
            Datatype::Enum { base, .. } => base,
            other => other,
        };
        let stored = match *datatype {
            Datatype::FixedPoint { size: size @ 1..=8, signed, byte_order } => {
                let number = if signed { Number::Signed } else { Number::Unsigned };
                (Some(number(usize::from(size))), byte_order)
            }
            Datatype::FloatingPoint { size, byte_order } => (Number::float(usize::from(size)), byte_order),
            _ => (None, ByteOrder::LittleEndian),
        };
        match stored {
            (Some(number), order) => Ok(Stored { number, order }),
            _ => {
                let expected = "whole numbers of at most 8 bytes, or floats of 4 or 8";
                Err(self.error(&column.field.name, expected, format!("{datatype:?}")))
            }
        }
    }

    /// A text of its own length, which a row only points to.
    fn stored_elsewhere(&self, place: &str, reference: &[u8]) -> Result<Vec<u8>, DataError> {
        let place = format!("{}, {place}", self.name);
        guarded(&self.file, &place, "a text", || self.dataset.resolve_vlen_reference_bytes(reference, 1))
    }

    fn error(&self, place: &str, expected: &str, found: String) -> DataError {
        DataError::content(&self.file, format!("{}, {place}", self.name), expected, found)
    }
}

impl Stored {
    /// What `read` makes of a number's bytes, lowest first.
    fn read<T>(self, bytes: &[u8], read: impl Fn(Number, &[u8]) -> T) -> T {
        if self.order == ByteOrder::LittleEndian {
            return read(self.number, bytes);
        }
        let mut lowest_first = [0; 8];
        let lowest_first = &mut lowest_first[..self.number.size()];
        lowest_first.iter_mut().zip(bytes.iter().rev()).for_each(|(to, from)| *to = *from);
        read(self.number, lowest_first)
    }
}

/// The size of a number or text that lies in the row, bytes.
fn size(datatype: &Datatype) -> Option<usize> {
    match datatype {
        Datatype::FixedPoint { size, .. } | Datatype::FloatingPoint { size, .. } => Some(usize::from(*size)),
        Datatype::String { size: StringSize::Fixed(size), .. } => Some(*size as usize),
        _ => None,
    }
}
