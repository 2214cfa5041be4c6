//! Recordings in and labels out: readers and writers of the formats that RALF knows.

mod error;
mod files;
mod recording;

pub use error::DataError;
pub use recording::{Recording, SequenceReader};
