//! Recordings in and labels out: readers and writers of the formats that RALF knows.

mod error;
mod files;
mod images;
mod models;
pub mod nuscenes;
mod recording;
#[cfg(test)]
mod testing;
pub mod view_of_delft;

pub use error::DataError;
pub use recording::{Recording, SequenceReader};
