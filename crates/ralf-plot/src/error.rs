//! What can go wrong while drawing.

/// Why a picture could not be drawn.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum PlotError {
    /// The picture's width lies outside what can be drawn and read.
    #[error("expected a width of {least} to {most} pixels, found {found}")]
    Width {
        /// Smallest width, pixels.
        least: u32,
        /// Largest width, pixels.
        most: u32,
        /// The width asked for, pixels.
        found: u32,
    },
    /// The radius of the view is no length.
    #[error("expected a radius of {least} to {most} m, found {found} m")]
    Radius {
        /// Smallest radius, m.
        least: f64,
        /// Largest radius, m.
        most: f64,
        /// The radius asked for, m.
        found: f64,
    },
    /// No memory for a picture of this size.
    #[error("no picture of {width} x {height} pixels can be made")]
    Size {
        /// Pixels.
        width: u32,
        /// Pixels.
        height: u32,
    },
    /// The built-in typeface can't be read.
    #[error("the built-in typeface can't be read: {0}")]
    Typeface(String),
    /// The detections can't be gone through.
    #[error("{0}")]
    Marks(String),
    /// The picture can't be encoded as PNG.
    #[error("the picture can't be encoded as PNG: {0}")]
    Encode(String),
}

/// Refuses widths outside `least..=most`.
pub(crate) fn check_width(found: u32, least: u32, most: u32) -> Result<(), PlotError> {
    if (least..=most).contains(&found) { Ok(()) } else { Err(PlotError::Width { least, most, found }) }
}
