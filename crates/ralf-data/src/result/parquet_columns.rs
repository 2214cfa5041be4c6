//! How columns lie in a Parquet file.

use super::schema::{Column, Kind};
use super::table::Values;
use crate::disk::parquet_table::read_group;
use bytes::Bytes;
use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical, ZstdLevel};
use parquet::column::writer::{ColumnCloseResult, ColumnWriterImpl};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, FloatType, Int32Type, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::properties::{EnabledStatistics, WriterProperties, WriterPropertiesPtr};
use parquet::file::reader::RowGroupReader;
use parquet::file::writer::{SerializedFileWriter, SerializedPageWriter, TrackedWrite};
use parquet::schema::types::{ColumnDescPtr, ColumnPath, SchemaDescriptor, Type};
use std::io::Write;
use std::sync::Arc;

/// Rows are written in groups of at least this many: what is in memory at a time.
pub(crate) const GROUP_ROWS: usize = 1 << 15;

/// The columns of a file, and how each is stored.
pub(crate) struct Layout {
    schema: Arc<Type>,
    columns: Vec<ColumnDescPtr>,
    properties: WriterPropertiesPtr,
}

/// A row group in memory, byte for byte as it will lie in the file.
pub(crate) struct EncodedGroup {
    bytes: Bytes,
    columns: Vec<ColumnCloseResult>,
}

impl Layout {
    /// A file with these columns, which is called `name` in its schema.
    ///
    /// Decimals are stored as they are: hardly two are the same, so that a dictionary costs more than it saves.
    pub(crate) fn new<'a>(
        name: &str,
        columns: impl IntoIterator<Item = &'a Column>,
    ) -> Result<Self, ParquetError> {
        let compression = Compression::ZSTD(ZstdLevel::try_new(3)?);
        // A group has a page or two of each column: what there is to say of pages, the group says.
        let mut properties = WriterProperties::builder()
            .set_compression(compression)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_offset_index_disabled(true);
        let mut fields = Vec::new();
        for column in columns {
            fields.push(field(column)?);
            if column.kind == Kind::F32 {
                let path = ColumnPath::from(vec![column.name.to_string()]);
                properties = properties.set_column_dictionary_enabled(path, false);
            }
        }
        let schema = Arc::new(Type::group_type_builder(name).with_fields(fields).build()?);
        let columns = SchemaDescriptor::new(schema.clone()).columns().to_vec();
        Ok(Self { schema, columns, properties: Arc::new(properties.build()) })
    }

    /// Begins a file.
    pub(crate) fn begin<W: Write + Send>(&self, file: W) -> Result<SerializedFileWriter<W>, ParquetError> {
        SerializedFileWriter::new(file, self.schema.clone(), self.properties.clone())
    }

    /// A row group of these values, column by column.
    pub(crate) fn encode<'a>(
        &self,
        values: impl IntoIterator<Item = &'a Values>,
    ) -> Result<EncodedGroup, ParquetError> {
        let mut sink = TrackedWrite::new(Vec::new());
        let columns = self.columns.iter().zip(values);
        let columns = columns.map(|(column, values)| self.encode_column(column, values, &mut sink));
        let columns = columns.collect::<Result<_, _>>()?;
        Ok(EncodedGroup { bytes: sink.into_inner()?.into(), columns })
    }

    fn encode_column(
        &self,
        column: &ColumnDescPtr,
        values: &Values,
        sink: &mut Sink,
    ) -> Result<ColumnCloseResult, ParquetError> {
        let column = NewColumn { column: column.clone(), properties: self.properties.clone(), sink };
        let whole = |values: &mut dyn Iterator<Item = i32>| values.collect::<Vec<i32>>();
        match values {
            Values::Text(values) => column.texts(values),
            Values::U8(values) => column.whole(&whole(&mut values.iter().map(|v| i32::from(*v)))),
            Values::U16(values) => column.whole(&whole(&mut values.iter().map(|v| i32::from(*v)))),
            Values::U32(values) => column.whole(&whole(&mut values.iter().map(|v| v.cast_signed()))),
            Values::I64(values) => column.write::<Int64Type>(values, None),
            Values::F32(values) => {
                let present: Vec<f32> = values.iter().copied().filter(|value| value.is_finite()).collect();
                let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_finite())).collect();
                column.write::<FloatType>(&present, Some(&levels))
            }
            Values::Class(values) => {
                let present: Vec<i32> = values.iter().flatten().map(|class| i32::from(*class)).collect();
                let levels: Vec<i16> = values.iter().map(|class| i16::from(class.is_some())).collect();
                column.write::<Int32Type>(&present, Some(&levels))
            }
            Values::Truth(values) => {
                let present: Vec<bool> = values.iter().flatten().copied().collect();
                let levels: Vec<i16> = values.iter().map(|value| i16::from(value.is_some())).collect();
                column.write::<BoolType>(&present, Some(&levels))
            }
        }
    }
}

impl EncodedGroup {
    /// Writes it behind the groups that a file has.
    pub(crate) fn append_to<W: Write + Send>(
        self,
        file: &mut SerializedFileWriter<W>,
    ) -> Result<(), ParquetError> {
        let mut group = file.next_row_group()?;
        for column in self.columns {
            group.append_column(&self.bytes, column)?;
        }
        group.close().map(drop)
    }
}

/// Where columns are encoded, one after the other.
type Sink = TrackedWrite<Vec<u8>>;

/// A column without values.
struct NewColumn<'a> {
    column: ColumnDescPtr,
    properties: WriterPropertiesPtr,
    sink: &'a mut Sink,
}

impl<'a> NewColumn<'a> {
    fn begin<T: DataType>(self) -> ColumnWriterImpl<'a, T> {
        let pages = Box::new(SerializedPageWriter::new(self.sink));
        ColumnWriterImpl::new(self.column, self.properties, pages)
    }

    fn whole(self, values: &[i32]) -> Result<ColumnCloseResult, ParquetError> {
        self.write::<Int32Type>(values, None)
    }

    /// `levels` say of each row whether it has a value.
    fn write<T: DataType>(
        self,
        values: &[T::T],
        levels: Option<&[i16]>,
    ) -> Result<ColumnCloseResult, ParquetError> {
        let mut column = self.begin::<T>();
        column.write_batch(values, levels, None)?;
        column.close()
    }

    /// Some at a time: many are a piece of memory of their own, of which a whole group has megabytes.
    fn texts(self, texts: &[Arc<str>]) -> Result<ColumnCloseResult, ParquetError> {
        /// What the writer takes at a time anyway.
        const AT_ONCE: usize = 1024;
        let mut column = self.begin::<ByteArrayType>();
        for texts in texts.chunks(AT_ONCE) {
            let mut batch: Vec<ByteArray> = Vec::with_capacity(texts.len());
            for (place, text) in texts.iter().enumerate() {
                // Of a text that stands in many rows, such as a radar's name, one piece is enough.
                let same = batch.last().filter(|_| Arc::ptr_eq(text, &texts[place - 1])).cloned();
                batch.push(same.unwrap_or_else(|| ByteArray::from(text.as_ref())));
            }
            column.write_batch(&batch, None, None)?;
        }
        column.close()
    }
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
