//! Why a report or a picture can't be made.

use ralf::sensors::SourceError;
use ralf_data::DataError;
use ralf_plot::PlotError;
use thiserror::Error;

/// Why a report or a picture can't be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// A file can't be read, or doesn't fit the others.
    #[error(transparent)]
    Data(#[from] DataError),
    /// A measurement can't be read.
    #[error(transparent)]
    Measurement(#[from] SourceError),
    /// A picture can't be drawn.
    #[error(transparent)]
    Picture(#[from] PlotError),
    /// A chart can't be drawn.
    #[error("chart: {0}")]
    Chart(String),
    /// None of the scans of a picture could be labelled: the first, and why.
    #[error("not labelled: {0}")]
    NotLabelled(String),
    /// Something was asked for that the recording doesn't hold.
    #[error("expected {expected}, found {found}")]
    Unknown {
        /// What there is.
        expected: String,
        /// What was asked for.
        found: String,
    },
}
