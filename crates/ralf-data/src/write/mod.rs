//! Recordings and labels out: the own layout, and other tools' formats.

mod dataset;
pub mod export;
mod metadata;
mod simulated;

pub use dataset::{write_sequence, write_sequence_with};
pub use metadata::has_sequence;
