//! How columns lie in a Parquet file.

use super::schema::{Column, Kind};
use super::table::Values;
use crate::disk::parquet_table::read_group;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::WriterProperties;
use parquet::file::reader::RowGroupReader;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::Type;
use std::io::Write;
use std::sync::Arc;

/// Rows are written in groups of at least this many.
pub(crate) const GROUP_ROWS: usize = 1 << 17;

/// Begins a file with these columns, which is called `name` in its schema.
pub(crate) fn begin<'a, W: Write + Send>(
    file: W,
    name: &str,
    columns: impl IntoIterator<Item = &'a Column>,
) -> Result<SerializedFileWriter<W>, ParquetError> {
    let fields = columns.into_iter().map(field).collect::<Result<Vec<_>, _>>()?;
    let schema = Type::group_type_builder(name).with_fields(fields).build()?;
    let compression = Compression::ZSTD(ZstdLevel::try_new(3)?);
    let properties = WriterProperties::builder().set_compression(compression).build();
    SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))
}

fn field(column: &Column) -> Result<Arc<Type>, ParquetError> {
    let unsigned = |bit_width| Some(LogicalType::integer(bit_width, false));
    let (physical, logical, repetition) = match column.kind {
        Kind::Text => (Physical::BYTE_ARRAY, Some(LogicalType::String), Repetition::REQUIRED),
        Kind::U8 => (Physical::INT32, unsigned(8), Repetition::REQUIRED),
        Kind::U16 => (Physical::INT32, unsigned(16), Repetition::REQUIRED),
        Kind::U32 => (Physical::INT32, unsigned(32), Repetition::REQUIRED),
        Kind::I64 => (Physical::INT64, None, Repetition::REQUIRED),
        Kind::F32 => (Physical::FLOAT, None, Repetition::OPTIONAL),
        Kind::Class => (Physical::INT32, unsigned(16), Repetition::OPTIONAL),
        Kind::Truth => (Physical::BOOLEAN, None, Repetition::OPTIONAL),
    };
    let builder = Type::primitive_type_builder(&column.name, physical);
    builder.with_logical_type(logical).with_repetition(repetition).build().map(Arc::new)
}

/// Writes the values of the next column of a row group.
pub(crate) fn write_values<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<W>,
    values: &Values,
) -> Result<(), ParquetError> {
    let whole = |values: &mut dyn Iterator<Item = i32>| values.collect::<Vec<i32>>();
    match values {
        Values::Text(values) => write_texts(group, values),
        Values::U8(values) => write_whole::<W>(group, &whole(&mut values.iter().map(|v| i32::from(*v)))),
        Values::U16(values) => write_whole::<W>(group, &whole(&mut values.iter().map(|v| i32::from(*v)))),
        Values::U32(values) => write_whole::<W>(group, &whole(&mut values.iter().map(|v| v.cast_signed()))),
        Values::I64(values) => write_column::<Int64Type, _>(group, values, None),
        Values::F32(values) => {
            let present: Vec<f32> = values.iter().copied().filter(|value| value.is_finite()).collect();
            let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_finite())).collect();
            write_column::<FloatType, _>(group, &present, Some(&levels))
        }
        Values::Class(values) => {
            let present: Vec<i32> = values.iter().flatten().map(|class| i32::from(*class)).collect();
            let levels: Vec<i16> = values.iter().map(|class| i16::from(class.is_some())).collect();
            write_column::<Int32Type, _>(group, &present, Some(&levels))
        }
        Values::Truth(values) => {
            let present: Vec<bool> = values.iter().flatten().copied().collect();
            let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
            write_column::<BoolType, _>(group, &present, Some(&levels))
        }
    }
}

fn write_whole<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<W>,
    values: &[i32],
) -> Result<(), ParquetError> {
    write_column::<Int32Type, _>(group, values, None)
}

/// Some at a time: each is a piece of memory of its own, of which a whole group has megabytes.
fn write_texts<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<W>,
    texts: &[Arc<str>],
) -> Result<(), ParquetError> {
    /// What the writer takes at a time anyway.
    const AT_ONCE: usize = 1024;
    let mut column = group.next_column()?.ok_or_else(none_left)?;
    for texts in texts.chunks(AT_ONCE) {
        let texts: Vec<ByteArray> = texts.iter().map(|text| ByteArray::from(text.as_ref())).collect();
        column.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
    }
    column.close()
}

/// `levels` say of each row whether it has a value.
fn write_column<T: DataType, W: Write + Send>(
    group: &mut SerializedRowGroupWriter<W>,
    values: &[T::T],
    levels: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let mut column = group.next_column()?.ok_or_else(none_left)?;
    column.typed::<T>().write_batch(values, levels, None)?;
    column.close()
}

fn none_left() -> ParquetError {
    ParquetError::General("more columns than the schema has".into())
}

/// Reads a column of a row group.
pub(crate) fn read_values(group: &dyn RowGroupReader, column: &Column) -> Result<Values, ParquetError> {
    let name = column.name.as_ref();
    Ok(match column.kind {
        Kind::Text => Values::Text(texts(group, name)?),
        Kind::U8 => Values::U8(present::<Int32Type>(group, name)?.into_iter().map(|v| v as u8).collect()),
        Kind::U16 => Values::U16(present::<Int32Type>(group, name)?.into_iter().map(|v| v as u16).collect()),
        Kind::U32 => {
            Values::U32(present::<Int32Type>(group, name)?.into_iter().map(i32::cast_unsigned).collect())
        }
        Kind::I64 => Values::I64(present::<Int64Type>(group, name)?),
        Kind::F32 => {
            let values = read_column::<FloatType>(group, name)?.into_iter();
            Values::F32(values.map(|value| value.unwrap_or(f32::NAN)).collect())
        }
        Kind::Class => {
            let values = read_column::<Int32Type>(group, name)?.into_iter();
            Values::Class(values.map(|value| value.map(|class| class as u16)).collect())
        }
        Kind::Truth => Values::Truth(read_column::<BoolType>(group, name)?),
    })
}

/// Texts; those that follow each other and are alike share their memory.
fn texts(group: &dyn RowGroupReader, name: &str) -> Result<Vec<Arc<str>>, ParquetError> {
    let mut texts: Vec<Arc<str>> = Vec::new();
    for bytes in present::<ByteArrayType>(group, name)? {
        let text = bytes.as_utf8()?;
        let same = texts.last().filter(|last| last.as_ref() == text).cloned();
        texts.push(same.unwrap_or_else(|| text.into()));
    }
    Ok(texts)
}

/// The values of a column that has one in every row.
fn present<T: DataType>(group: &dyn RowGroupReader, name: &str) -> Result<Vec<T::T>, ParquetError> {
    let values = read_column::<T>(group, name)?.into_iter().collect::<Option<Vec<_>>>();
    values.ok_or_else(|| ParquetError::General(format!("column `{name}` has rows without a value")))
}

/// A column of a row group by name, `None` where a value is absent.
fn read_column<T: DataType>(
    group: &dyn RowGroupReader,
    name: &str,
) -> Result<Vec<Option<T::T>>, ParquetError> {
    let schema = group.metadata().schema_descr();
    let at = schema.columns().iter().position(|column| column.name() == name);
    let at = at.ok_or_else(|| ParquetError::General(format!("no column `{name}`")))?;
    if schema.column(at).physical_type() != T::get_physical_type() {
        return Err(ParquetError::General(format!("column `{name}` has another type")));
    }
    let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
    let mut values = Vec::new();
    read_group::<T, _>(group, at, &|value| Some(value.clone()), &None, &mut values, rows)?;
    if values.len() == rows {
        return Ok(values);
    }
    let found = values.len();
    Err(ParquetError::General(format!("column `{name}` has {found} of {rows} rows")))
}
