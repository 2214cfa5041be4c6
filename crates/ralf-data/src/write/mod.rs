//! Recordings and labels out: the own layout, and other tools' formats.

mod dataset;
pub mod export;
mod measurements;
mod metadata;
mod present;
mod simulated;
mod target;

pub use dataset::{write_sequence, write_sequence_with};
pub use present::{has_sequence, has_whole_sequence};
