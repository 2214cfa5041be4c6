//! A labelled sequence's columns, lent by the Arrow C interface and to NumPy.

use crate::arrays::Column;
use crate::errors;
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::types::{Float32Type, Int64Type, UInt8Type, UInt16Type, UInt32Type};
use arrow_array::{
    Array, ArrayRef, ArrowPrimitiveType, BooleanArray, PrimitiveArray, RecordBatch, RecordBatchIterator,
    StringArray,
};
use arrow_buffer::NullBuffer;
use arrow_schema::{ArrowError, DataType, Field, Schema, SchemaRef};
use pyo3::exceptions::{PyIndexError, PyKeyError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::PyCapsule;
use ralf_data::DataError;
use ralf_data::result::{
    Column as ResultColumn, Kind, PlausibilityReader, RadarScanKey, Table as ResultTable, Values,
};
use std::collections::HashMap;
use std::sync::Arc;

/// Where a scan's rows lie: radar, number of the scan, batch, first row in it, number of rows.
type Span = (String, usize, usize, usize, usize);

/// Labelled detections, a row each, in batches. Arrow libraries read it without a copy: `pyarrow.table(table)`,
/// `polars.DataFrame(table)`.
#[pyclass(frozen, module = "ralf._ralf")]
pub(crate) struct Table {
    schema: SchemaRef,
    batches: Vec<RecordBatch>,
    spans: Vec<Span>,
}

impl Table {
    /// All that a result holds.
    pub(crate) fn read(reader: &PlausibilityReader) -> Result<Self, DataError> {
        let mut groups = Vec::with_capacity(reader.groups());
        for group in 0..reader.groups() {
            let scans = reader.scans_of_group(group).map(|(key, rows)| (key.clone(), rows)).collect();
            groups.push((reader.group(group)?, scans));
        }
        Self::of_groups(reader.schema().with_scan().columns(), groups).map_err(|error| {
            DataError::content(reader.file(), "columns", "columns of equal length", error.to_string())
        })
    }

    /// Groups of rows with these columns, each with its scans and their rows.
    pub(crate) fn of_groups(
        columns: &[ResultColumn],
        groups: Vec<(ResultTable, Vec<(RadarScanKey, usize)>)>,
    ) -> Result<Self, ArrowError> {
        let schema = Arc::new(Schema::new(columns.iter().map(field).collect::<Vec<_>>()));
        let (mut batches, mut spans) = (Vec::new(), Vec::new());
        for (number, (table, scans)) in groups.into_iter().enumerate() {
            let mut first = 0;
            for (key, rows) in scans {
                spans.push((key.radar.to_string(), key.scan, number, first, rows));
                first += rows;
            }
            let arrays = table.into_values().into_iter().map(array).collect();
            batches.push(RecordBatch::try_new(schema.clone(), arrays)?);
        }
        Ok(Self { schema, batches, spans })
    }
}

/// How a column is called in Arrow, with its unit and meaning.
fn field(column: &ResultColumn) -> Field {
    let (kind, absent) = match column.kind {
        Kind::Text => (DataType::Utf8, false),
        Kind::U8 => (DataType::UInt8, false),
        Kind::U16 => (DataType::UInt16, false),
        Kind::U32 => (DataType::UInt32, false),
        Kind::I64 => (DataType::Int64, false),
        Kind::F32 => (DataType::Float32, true),
        Kind::Class => (DataType::UInt16, true),
        Kind::Truth => (DataType::Boolean, true),
    };
    let told = [("unit", column.unit), ("meaning", column.meaning)];
    let told = told.map(|(key, value)| (key.to_owned(), value.to_owned()));
    Field::new(column.name.as_ref(), kind, absent).with_metadata(HashMap::from(told))
}

/// Values as an array, in the memory where they are, wherever Arrow has them in the same shape.
fn array(values: Values) -> ArrayRef {
    fn plain<T: ArrowPrimitiveType>(values: Vec<T::Native>) -> ArrayRef {
        Arc::new(PrimitiveArray::<T>::new(values.into(), None))
    }
    match values {
        Values::Text(values) => Arc::new(StringArray::from_iter_values(values)),
        Values::U8(values) => plain::<UInt8Type>(values),
        Values::U16(values) => plain::<UInt16Type>(values),
        Values::U32(values) => plain::<UInt32Type>(values),
        Values::I64(values) => plain::<Int64Type>(values),
        Values::F32(mut values) => {
            // An infinite one is absent as NaN is: views of the memory tell both alike.
            values.iter_mut().filter(|value| value.is_infinite()).for_each(|value| *value = f32::NAN);
            let present: NullBuffer = values.iter().map(|value| value.is_finite()).collect();
            let nulls = (present.null_count() > 0).then_some(present);
            Arc::new(PrimitiveArray::<Float32Type>::new(values.into(), nulls))
        }
        Values::Class(values) => Arc::new(PrimitiveArray::<UInt16Type>::from(values)),
        Values::Truth(values) => Arc::new(BooleanArray::from(values)),
    }
}

#[pymethods]
impl Table {
    /// The table by the Arrow C stream interface; its memory is lent, not copied.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        // Whoever asks for another schema casts, as the interface allows.
        drop(requested_schema);
        let batches = self.batches.clone().into_iter().map(Ok);
        let reader = RecordBatchIterator::new(batches, self.schema.clone());
        let stream = FFI_ArrowArrayStream::new(Box::new(reader));
        PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
    }

    fn __len__(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    /// The names of the columns.
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.schema.fields().iter().map(|field| field.name().clone()).collect()
    }

    /// The unit and the meaning of a column.
    fn told(&self, name: &str) -> PyResult<(String, String)> {
        let field = self.schema.field(self.place(name)?);
        let of = |key: &str| field.metadata().get(key).cloned().unwrap_or_default();
        Ok((of("unit"), of("meaning")))
    }

    /// The number of batches.
    #[getter]
    fn batches(&self) -> usize {
        self.batches.len()
    }

    /// Where each scan's rows lie: radar, number of the scan, batch, first row in it, number of rows.
    #[getter]
    fn scans(&self) -> Vec<Span> {
        self.spans.clone()
    }

    /// A column of numbers in a batch. Absent decimals are NaN, absent classes 0.
    fn column(&self, name: &str, batch: usize) -> PyResult<Column> {
        let place = self.place(name)?;
        let batches = self.batches.len();
        let batch = self.batches.get(batch).ok_or_else(|| {
            PyIndexError::new_err(format!("expected a batch below {batches}, found {batch}"))
        })?;
        let typestr = match self.schema.field(place).data_type() {
            DataType::UInt8 => "|u1",
            DataType::UInt16 => "<u2",
            DataType::UInt32 => "<u4",
            DataType::Int64 => "<i8",
            DataType::Float32 => "<f4",
            other => {
                return Err(PyTypeError::new_err(format!(
                    "expected numbers, found {other} in column {name}"
                )));
            }
        };
        let data = batch.column(place).to_data();
        let buffer = data.buffers().first().cloned().unwrap_or_else(|| Vec::<u8>::new().into());
        Ok(Column::new(buffer, typestr, batch.num_rows(), 1))
    }
}

impl Table {
    fn place(&self, name: &str) -> PyResult<usize> {
        self.schema.index_of(name).map_err(|_| {
            PyKeyError::new_err(format!("expected one of {}, found {name}", self.columns().join(", ")))
        })
    }
}

/// A table, or the exception that tells why not.
pub(crate) fn table_of(reader: &PlausibilityReader) -> PyResult<Table> {
    Table::read(reader).map_err(errors::data)
}
