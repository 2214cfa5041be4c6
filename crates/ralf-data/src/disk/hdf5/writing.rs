//! Tables written as HDF5 files, for tests of readers.

use hdf5_writer::{
    ByteOrder, CompoundField, DatasetBuilder, Datatype, FilterDescription, Hdf5Builder, StringEncoding,
    StringPadding, StringSize, WriteOptions,
};
use std::fs;
use std::path::Path;

/// The values of a column, in the type in which they are stored.
#[derive(Debug, Clone)]
pub(crate) enum Values {
    Int(Vec<i32>),
    Long(Vec<i64>),
    Float(Vec<f32>),
    Double(Vec<f64>),
    Byte(Vec<u8>),
    /// Whole numbers of so many bytes, with a sign.
    Whole(u8, Vec<i64>),
    /// Of so many bytes.
    Text(u32, Vec<String>),
}

/// Columns by name.
pub(crate) type Columns = Vec<(&'static str, Values)>;

/// Writes a file with these tables, compressed in chunks of so many rows.
pub(crate) fn write_tables(file: &Path, tables: &[(&str, &Columns)], chunk: u64) {
    let mut builder = Hdf5Builder::new();
    for (name, columns) in tables {
        let rows = columns[0].1.len();
        let fields = fields(columns);
        let size = columns.iter().map(|(_, values)| values.bytes()).sum();
        let bytes: Vec<u8> = (0..rows).flat_map(|row| row_bytes(columns, row)).collect();
        let mut dataset = DatasetBuilder::new(*name, Datatype::Compound { size, fields }, vec![rows as u64])
            .raw_data(bytes);
        if rows > 0 {
            let gzip =
                FilterDescription { id: hdf5_writer::FILTER_DEFLATE, name: None, client_data: vec![4] };
            dataset = dataset.chunked(vec![chunk]).filter(gzip);
        }
        builder = builder.dataset(dataset);
    }
    let bytes = builder.into_plan().unwrap().encode(WriteOptions::default()).unwrap();
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, bytes).unwrap();
}

fn fields(columns: &Columns) -> Vec<CompoundField> {
    let mut byte_offset = 0;
    let field = |(name, values): &(&'static str, Values)| {
        let field = CompoundField { name: (*name).to_owned(), byte_offset, datatype: values.datatype() };
        byte_offset += values.bytes();
        field
    };
    columns.iter().map(field).collect()
}

fn row_bytes(columns: &Columns, row: usize) -> Vec<u8> {
    columns.iter().flat_map(|(_, values)| values.row(row)).collect()
}

impl Values {
    fn len(&self) -> usize {
        match self {
            Self::Int(values) => values.len(),
            Self::Long(values) => values.len(),
            Self::Float(values) => values.len(),
            Self::Double(values) => values.len(),
            Self::Byte(values) => values.len(),
            Self::Whole(_, values) => values.len(),
            Self::Text(_, values) => values.len(),
        }
    }

    /// These rows, in this order.
    pub(crate) fn picked(&self, rows: &[usize]) -> Self {
        fn of<T: Clone>(values: &[T], rows: &[usize]) -> Vec<T> {
            rows.iter().map(|row| values[*row].clone()).collect()
        }
        match self {
            Self::Int(values) => Self::Int(of(values, rows)),
            Self::Long(values) => Self::Long(of(values, rows)),
            Self::Float(values) => Self::Float(of(values, rows)),
            Self::Double(values) => Self::Double(of(values, rows)),
            Self::Byte(values) => Self::Byte(of(values, rows)),
            Self::Whole(bytes, values) => Self::Whole(*bytes, of(values, rows)),
            Self::Text(bytes, values) => Self::Text(*bytes, of(values, rows)),
        }
    }

    fn bytes(&self) -> u32 {
        match self {
            Self::Int(_) | Self::Float(_) => 4,
            Self::Long(_) | Self::Double(_) => 8,
            Self::Byte(_) => 1,
            Self::Whole(bytes, _) => u32::from(*bytes),
            Self::Text(bytes, _) => *bytes,
        }
    }

    fn datatype(&self) -> Datatype {
        let (size, byte_order) = (self.bytes() as u8, ByteOrder::LittleEndian);
        match self {
            Self::Int(_) | Self::Long(_) | Self::Whole(..) => {
                Datatype::FixedPoint { size, signed: true, byte_order }
            }
            Self::Byte(_) => Datatype::FixedPoint { size, signed: false, byte_order },
            Self::Float(_) | Self::Double(_) => Datatype::FloatingPoint { size, byte_order },
            Self::Text(bytes, _) => Datatype::String {
                size: StringSize::Fixed(*bytes),
                encoding: StringEncoding::Ascii,
                padding: StringPadding::NullPad,
            },
        }
    }

    fn row(&self, row: usize) -> Vec<u8> {
        match self {
            Self::Int(values) => values[row].to_le_bytes().into(),
            Self::Long(values) => values[row].to_le_bytes().into(),
            Self::Float(values) => values[row].to_le_bytes().into(),
            Self::Double(values) => values[row].to_le_bytes().into(),
            Self::Byte(values) => vec![values[row]],
            Self::Whole(bytes, values) => i128::from(values[row]).to_le_bytes()[..usize::from(*bytes)].into(),
            Self::Text(bytes, values) => {
                let mut text = values[row].clone().into_bytes();
                text.resize(*bytes as usize, 0);
                text
            }
        }
    }
}
