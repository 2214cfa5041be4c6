//! What the radars saw at the time of a neighbouring scan.

use crate::config::TrackingSources;
use crate::scene::{Association, Detection, NeighbouringScan, Reference, ScanStep, index_of, reach_of_cap};
use crate::sensors::Elevation;
use crate::space::NeighborIndex;

/// The detections of a step in the vehicle frame at the reference scan's time.
///
/// Moving some hundred points and sorting them costs less than it saves to ask each scan in its own frame, and
/// horizontal distances are exact only here.
pub(super) struct MovedCloud {
    pub(super) points: Vec<Detection>,
    pub(super) index: NeighborIndex,
    /// No point's variance in any direction is larger, m^2.
    max_variance: f64,
}

impl MovedCloud {
    pub(super) fn new(step: &ScanStep, elevation: Elevation, sources: TrackingSources) -> Self {
        let mut points = Vec::new();
        for NeighbouringScan { scan, vehicle_from_scan, .. } in scans_of(step, sources) {
            points.extend(scan.moved(vehicle_from_scan).flatten());
        }
        let index = index_of(points.iter().map(|point| &point.position), elevation);
        let max_variance = points.iter().map(Detection::total_variance).fold(0.0, f64::max);
        Self { points, index, max_variance }
    }

    /// Farther than this, m, every mismatch with the detection is above the cap.
    pub(super) fn reach(&self, detection: &Detection, cap: f64) -> f64 {
        reach_of_cap(cap, detection.total_variance() + self.max_variance)
    }

    /// The mean mismatch of a detection with its nearest points; infinite where the step saw nothing, so that the cap
    /// takes its place.
    pub(super) fn mismatch(&self, association: &mut Association, detection: &Detection) -> f64 {
        let found = association.mean_mismatch(detection, &detection.position, |id| self.reference(id));
        found.unwrap_or(f64::INFINITY)
    }

    pub(super) fn reference(&self, id: u32) -> Reference {
        let point = &self.points[id as usize];
        Reference { position: point.position, spread: point.spread() }
    }
}

/// The scans of a step that a detection is sought in.
pub(super) fn scans_of(step: &ScanStep, sources: TrackingSources) -> impl Iterator<Item = &NeighbouringScan> {
    let others = if sources == TrackingSources::All { step.others.as_slice() } else { &[] };
    [&step.own].into_iter().chain(others)
}
