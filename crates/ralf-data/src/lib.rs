//! Recordings in and labels out: readers and writers of the formats that RALF knows.

mod error;
mod evaluation;
mod files;
mod ground_truth;
mod images;
mod label_file;
mod models;
pub mod nuscenes;
pub mod output;
mod recording;
pub mod run;
#[cfg(test)]
mod testing;
pub mod view_of_delft;

pub use error::DataError;
pub use evaluation::Comparison;
pub use ground_truth::{GroundTruth, ScanId};
pub use label_file::{Label, read_labels, write_labels};
pub use recording::{Recording, SequenceReader};
