//! The radar scans around a scan.

use super::detections::Detections;
use crate::space::Transform;
use std::sync::Arc;

/// What the radars saw at one neighbouring scan's time.
#[derive(Debug, Clone)]
pub struct TrackingStep {
    /// `j`: how many scans of the same radar it comes after the reference scan; negative before it.
    pub j: isize,
    /// Time of the same radar's scan, ns.
    pub t_ns: i64,
    /// That scan, and with `tracking.sources = "all"` the other radars' nearest in time; each with the transform into
    /// the vehicle frame at the reference scan's time.
    pub clouds: Vec<(Arc<Detections>, Transform)>,
}
