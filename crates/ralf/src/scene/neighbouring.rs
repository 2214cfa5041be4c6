//! The radar scans around a scan.

use super::located::LocatedScan;
use crate::space::Transform;
use std::sync::Arc;

/// A scan of any radar, seen from the reference scan.
#[derive(Debug, Clone)]
pub struct NeighbouringScan {
    /// Which radar made it: its index in the rig.
    pub radar: usize,
    /// The scan, in the vehicle frame at its own time.
    pub scan: Arc<LocatedScan>,
    /// From the vehicle frame at that time to that at the reference scan's (paper, equation 8).
    pub vehicle_from_scan: Transform,
}

/// What the radars saw at the time of one neighbouring scan of the reference scan's radar.
#[derive(Debug, Clone)]
pub struct ScanStep {
    /// `j`: how many scans of the same radar it comes after the reference scan; negative before it.
    pub j: isize,
    /// Time of the same radar's scan, ns.
    pub t_ns: i64,
    /// That scan.
    pub own: NeighbouringScan,
    /// The other radars' scans nearest to it in time, in the rig's order. Empty unless `tracking.sources = "all"`.
    pub others: Vec<NeighbouringScan>,
}
