//! What a labelling run writes: `plausibility.parquet`, `.label` files and `run.json`.

mod columns;
mod parquet_file;
mod rows_file;
mod rows_read;
mod scan_tables;
mod table;

pub use columns::Columns;
pub use parquet_file::PlausibilityWriter;
pub use rows_read::{LabelledRows, read_labelled_rows};
pub use scan_tables::{PlausibilityReader, ScanTables};
pub use table::ScanTable;

pub(crate) use columns::ANSWERS;
pub(crate) use parquet_file::{field, write_column, written};
pub(crate) use rows_file::{read_rows, write_rows};
