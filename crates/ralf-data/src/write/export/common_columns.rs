//! Columns that all files of a data set have. Sequences differ in their radars' fields, and in whether cameras tell
//! classes; who reads a data set takes the columns of its first file for those of all, and never sees the others.

use super::Contents;
use super::columns::{table_columns, table_schema};
use super::labelled::{LabelledScan, LabelledSequence};
use crate::error::DataError;
use crate::result::{CLASS_FROM, ClassSource, Column, Schema, Table, Values};
use std::sync::Arc;

/// The columns of any sequence of an export, each once.
pub(super) struct CommonColumns {
    schema: Arc<Schema>,
}

impl CommonColumns {
    /// Those of these contents, as the ends of the results' files tell them.
    pub(super) fn new(contents: &Contents) -> Result<Self, DataError> {
        let mut columns = Vec::new();
        for (reader, _) in contents.sequences {
            // What can't be read of a result is told when its sequence is written.
            if let Ok(results) = contents.run.columns(*reader) {
                add(&mut columns, table_schema(results, contents.sensors)?.columns());
            }
        }
        Ok(Self { schema: Arc::new(Schema::new(columns)) })
    }

    /// A scan as [`table_columns`] tells it, with all columns: absent is what its sequence doesn't have.
    ///
    /// # Errors
    /// Those of [`table_columns`], and a column that is of another kind in another sequence.
    pub(super) fn table(&self, sequence: &LabelledSequence, scan: &LabelledScan) -> Result<Table, DataError> {
        let table = table_columns(sequence, scan)?;
        if table.schema() == &self.schema {
            return Ok(table);
        }
        let values = |column: &Column| match table.schema().place(&column.name) {
            Ok(place) => Ok(table.values()[place].clone()),
            Err(_) if column.name == CLASS_FROM.name => class_from(scan),
            Err(_) => Ok(Values::absent(column.kind, table.len())),
        };
        let values = self.schema.columns().iter().map(values).collect::<Result<_, DataError>>()?;
        Table::new(self.schema.clone(), values)
    }
}

/// What tells the classes where no camera was asked: empty would say that there are none.
fn class_from(scan: &LabelledScan) -> Result<Values, DataError> {
    let sources = scan.table.class_sources()?;
    let name = |row: &usize| sources[*row].map_or("", ClassSource::name).into();
    Ok(Values::Text(scan.kept.iter().map(name).collect()))
}

/// Adds the columns that aren't there yet, each behind the one that it follows.
fn add(all: &mut Vec<Column>, columns: &[Column]) {
    let mut next = 0;
    for column in columns {
        match all.iter().position(|known| known.name == column.name) {
            Some(place) => next = place + 1,
            None => {
                all.insert(next, column.clone());
                next += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::schema::field;

    #[test]
    fn columns_come_in_the_order_of_every_sequence() {
        let mut all = Vec::new();
        for names in [["x", "rcs", "w"], ["x", "snr", "w"], ["rcs", "w", "cause"]] {
            add(&mut all, &names.map(field));
        }
        let names: Vec<&str> = all.iter().map(|column| column.name.as_ref()).collect();
        assert_eq!(names, ["x", "snr", "rcs", "w", "cause"]);
    }
}
