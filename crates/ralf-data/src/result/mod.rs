//! What a labelling run leaves: tables, `.label` files and `run.json`, and the one door to them.

mod check_record;
mod class_source;
mod content;
pub(crate) mod json;
mod label_hash;
mod labelled_run;
mod learned_columns;
mod links;
mod lock;
mod names;
mod own_files;
pub(crate) mod own_folder;
mod parquet_columns;
mod parquet_reader;
mod parquet_writer;
mod places;
mod record;
mod row_bytes;
mod scan_table;
pub(crate) mod schema;
mod sequence_record;
mod sisters;
mod table;
pub(crate) mod under_way;
mod without_numbers;

pub use check_record::{CheckLine, CheckRecord};
pub use class_source::ClassSource;
pub use labelled_run::{Change, ChangedInput, LabelledRun, LabelledSequence, labelled_recording};
pub use names::Component;
pub use parquet_reader::PlausibilityReader;
pub use parquet_writer::PlausibilityWriter;
pub use places::Places;
pub use record::{Input, RunRecord, Timings, program, read_record};
pub use scan_table::RadarScanKey;
pub use schema::{Column, Group, Kind, Schema};
pub(crate) use sequence_record::ScanNotes;
pub use sequence_record::{
    CameraRecord, FileRecord, ImageRecord, NotLabelled, RadarRecord, SequenceRecord, UnreadMeasurement,
    UnreadableScan,
};
pub(crate) use sisters::RadarCounts;
pub use sisters::UnlikeSisters;
pub use table::{Table, Value, Values};
pub use under_way::is_under_way;
pub(crate) use without_numbers::Numbers;
pub use without_numbers::WithoutNumbers;

pub(crate) use content::{changed_ns, damaged_result, hash_file};
pub(crate) use learned_columns::learned_columns;
pub use learned_columns::share_column;
pub(crate) use links::{refuse_links_on_way, refuse_links_out};
pub(crate) use lock::WriterLock;
pub(crate) use names::{OutFolder, SequenceNames, checked};
pub(crate) use own_files::told_within;
pub(crate) use parquet_columns::{EncodedGroup, GROUP_ROWS, Layout};
pub(crate) use parquet_writer::{RowGroup, written};
pub(crate) use row_bytes::{row_bytes, table_of_rows};
pub(crate) use scan_table::ScanParts;
pub(crate) use schema::{CLASS_FROM, evidence_columns};
