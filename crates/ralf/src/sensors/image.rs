//! Images, as a camera and as networks deliver them.

use serde::{Deserialize, Serialize};
use std::fmt;
use thiserror::Error;

/// An 8-bit colour image.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CameraImage {
    /// px.
    pub width: usize,
    /// px.
    pub height: usize,
    /// Red, green, blue, row by row from the top.
    pub rgb: Vec<[u8; 3]>,
}

/// An image of another size than its camera is calibrated for, which a source refuses before it decodes it.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("{reason}")]
pub struct ImageSizeError {
    /// Its width and height, px.
    pub found: [usize; 2],
    /// File, place, expected, found.
    pub reason: String,
}

/// What a depth network gave for one view.
#[derive(Debug, Clone, PartialEq)]
pub struct DepthImage {
    /// px.
    pub width: usize,
    /// px.
    pub height: usize,
    /// Row by row from the top; NaN and values of 0 or below mean no depth.
    pub values: Vec<f32>,
}

/// What a segmentation network gave for one view.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ClassImage {
    /// px.
    pub width: usize,
    /// px.
    pub height: usize,
    /// SemanticKITTI ids, row by row from the top; [`UNLABELED`](crate::label::UNLABELED) where there is none, as in
    /// the sky.
    pub ids: Vec<u8>,
}

/// The meaning of a depth image's values.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum DepthOutput {
    /// Relative depth: larger is farther.
    #[default]
    Depth,
    /// Relative disparity: larger is nearer.
    Disparity,
    /// Depth in metres.
    Metric,
}

impl fmt::Display for DepthOutput {
    /// As `sequence.toml` and cards of networks have it.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Depth => "depth",
            Self::Disparity => "disparity",
            Self::Metric => "metric",
        })
    }
}
