//! Recordings and labels out: the own layout, and other tools' formats.

mod dataset;
pub mod export;
mod simulated;

pub use dataset::write_sequence;
pub use simulated::write_simulated;
