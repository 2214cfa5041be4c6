//! What a labelling run writes: `plausibility.parquet`, `.label` files and `run.json`.

mod check_record;
mod columns;
mod content;
pub(crate) mod json;
mod label_hash;
mod labelled_run;
mod lock;
mod names;
mod parquet_file;
mod places;
mod record;
mod rows_file;
mod rows_read;
mod scan_tables;
mod sequence_record;
mod table;

pub use check_record::{CheckLine, CheckRecord};
pub use columns::Columns;
pub use labelled_run::{Change, ChangedInput, LabelledRun, LabelledSequence};
pub use names::Component;
pub use parquet_file::PlausibilityWriter;
pub use record::{Input, RunRecord, Timings, read_record};
pub use rows_read::{LabelledRows, read_labelled_rows};
pub use scan_tables::{PlausibilityReader, ScanTables};
pub(crate) use sequence_record::ScanNotes;
pub use sequence_record::{
    CameraRecord, FileRecord, ImageRecord, NotLabelled, RadarRecord, SequenceRecord, UnreadableScan,
};
pub use table::ScanTable;

pub(crate) use columns::ANSWERS;
pub(crate) use content::{changed_ns, damaged_result, hash_file};
pub(crate) use lock::WriterLock;
pub(crate) use names::{OutFolder, SequenceNames, checked};
pub(crate) use parquet_file::{field, write_column, written};
pub(crate) use places::Places;
pub(crate) use record::RECORD;
pub(crate) use rows_file::{read_rows, write_rows};
