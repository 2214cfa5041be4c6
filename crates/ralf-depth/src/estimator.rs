//! What the rest of the program knows of a depth network.

use crate::NetworkError;
use ralf::sensors::{CameraImage, DepthImage, DepthOutput};

/// Estimates the depth of a view from its colours alone.
///
/// Estimates are deterministic, and may be asked for from several threads at once.
pub trait DepthEstimator: Send + Sync {
    /// The depth of each pixel of a straight view with a focal length of `focal` px.
    ///
    /// Networks that were trained for one focal length ([`crate::Card::canonical_focal`]) turn their depth metric with
    /// it; others don't look at it.
    fn estimate(&self, view: &CameraImage, focal: f64) -> Result<DepthImage, NetworkError>;

    /// What the values mean.
    fn output(&self) -> DepthOutput;

    /// Changes with anything that changes the estimates: a stored depth image with the same fingerprint needn't be
    /// computed again.
    fn fingerprint(&self) -> &str;
}
