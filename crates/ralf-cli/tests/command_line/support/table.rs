//! `plausibility.parquet` as another program reads it.

use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::Field;
use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

/// A row by column.
pub(crate) struct Row(BTreeMap<String, Field>);

impl Row {
    /// The radar's name.
    #[track_caller]
    pub(crate) fn radar(&self) -> &str {
        self.text("radar").unwrap()
    }

    /// A column of texts; `None` is null.
    #[track_caller]
    pub(crate) fn text(&self, column: &str) -> Option<&str> {
        match &self.0[column] {
            Field::Null => None,
            Field::Str(value) => Some(value),
            other => panic!("{column}: {other:?}"),
        }
    }

    /// A column of whole numbers; `None` is null.
    #[track_caller]
    pub(crate) fn whole(&self, column: &str) -> Option<i64> {
        match &self.0[column] {
            Field::Null => None,
            Field::UByte(value) => Some(i64::from(*value)),
            Field::UShort(value) => Some(i64::from(*value)),
            Field::UInt(value) => Some(i64::from(*value)),
            Field::Long(value) => Some(*value),
            other => panic!("{column}: {other:?}"),
        }
    }

    /// A column of decimals; `None` is null.
    #[track_caller]
    pub(crate) fn decimal(&self, column: &str) -> Option<f64> {
        match &self.0[column] {
            Field::Null => None,
            Field::Float(value) => Some(f64::from(*value)),
            other => panic!("{column}: {other:?}"),
        }
    }
}

fn open(file: &Path) -> SerializedFileReader<File> {
    SerializedFileReader::new(File::open(file).unwrap()).unwrap()
}

/// All rows in their order.
pub(crate) fn rows(file: impl AsRef<Path>) -> Vec<Row> {
    let reader = open(file.as_ref());
    let fields = |row: parquet::record::Row| row.into_columns().into_iter().collect();
    reader.get_row_iter(None).unwrap().map(|row| Row(fields(row.unwrap()))).collect()
}

/// A line per column: name, type on disk, meaning, and whether a value may be absent.
pub(crate) fn schema(file: impl AsRef<Path>) -> Vec<String> {
    let reader = open(file.as_ref());
    let columns = reader.metadata().file_metadata().schema_descr().columns();
    let line = |column: &parquet::schema::types::ColumnDescPtr| {
        let null = if column.max_def_level() > 0 { " or null" } else { "" };
        format!("{}: {} {}{null}", column.name(), column.physical_type(), column.converted_type())
    };
    columns.iter().map(line).collect()
}
