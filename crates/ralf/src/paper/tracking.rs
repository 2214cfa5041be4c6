//! Tracking: what exists reoccurs in the neighbouring radar scans, clutter and noise do not (paper, equation 8;
//! docs/method.md, section 7).

use crate::config::{TrackingConfig, TrackingSources};
use crate::scene::{
    Association, Detection, Frame, NeighbouringScan, Reference, ScanStep, distance_per_mismatch, index_of,
};
use crate::sensors::{Elevation, Radar};
use crate::space::NeighborIndex;

/// The mismatch `d` of each detection with the neighbouring scans, sorted and weighted; `None` for all where the branch
/// is off or there is no such scan, and for detections without a position.
pub fn match_detections(frame: &Frame, config: &TrackingConfig) -> Vec<Option<f64>> {
    let steps = if config.enabled { frame.steps_within(config.scans) } else { &[] };
    let doppler = if config.dynamic { frame.doppler() } else { None };
    let mut mismatches = vec![Vec::with_capacity(steps.len()); frame.scan.len()];
    for step in steps {
        let cloud = MovedCloud::new(step, frame.radar.elevation, config.sources);
        let mut association = Association::new(&cloud.index, frame.radar.elevation, config.neighbours);
        let dt = (step.t_ns - frame.scan.t_ns()) as f64 * 1e-9;
        for (i, detection) in frame.scan.detections.iter().enumerate() {
            let Some(detection) = detection else { continue };
            association.set_reach(cloud.reach(detection, config.max_mismatch));
            let mut d = cloud.mismatch(&mut association, detection);
            let velocity = doppler.as_ref().map(|doppler| doppler.compensated[i]);
            if let Some(velocity) = velocity.filter(|velocity| velocity.is_finite()) {
                let moved = along_ray(frame.radar, detection, velocity * dt);
                d = d.min(cloud.mismatch(&mut association, &moved));
            }
            mismatches[i].push(d.min(config.max_mismatch));
        }
    }
    mismatches.iter_mut().map(|of_steps| sorted_mean(of_steps)).collect()
}

/// `sum c_k d_(k) / sum c_k` over the ascending `d_(k)`, with `c_k = n - k + 1`. `None` where there are none.
fn sorted_mean(mismatches: &mut [f64]) -> Option<f64> {
    mismatches.sort_by(f64::total_cmp);
    let n = mismatches.len();
    let weighted: f64 = mismatches.iter().enumerate().map(|(k, d)| (n - k) as f64 * d).sum();
    (n > 0).then(|| weighted / (n * (n + 1) / 2) as f64)
}

/// The detection moved away from the radar by a distance, m, its uncertainty with it.
fn along_ray(radar: &Radar, detection: &Detection, distance: f64) -> Detection {
    let from_radar = detection.position.coords - radar.vehicle_from_radar.translation.vector;
    let ray = from_radar.try_normalize(0.0).unwrap_or_default();
    Detection { position: detection.position + ray * distance, axes: detection.axes }
}

/// The detections of a step in the vehicle frame at the reference scan's time.
///
/// Moving some hundred points and sorting them costs less than it saves to ask each scan in its own frame, and
/// horizontal distances are exact only here.
struct MovedCloud {
    points: Vec<Detection>,
    index: NeighborIndex,
    /// No point's variance in any direction is larger, m^2.
    max_variance: f64,
}

impl MovedCloud {
    fn new(step: &ScanStep, elevation: Elevation, sources: TrackingSources) -> Self {
        let others = if sources == TrackingSources::All { step.others.as_slice() } else { &[] };
        let mut points = Vec::new();
        for NeighbouringScan { scan, vehicle_from_scan, .. } in [&step.own].into_iter().chain(others) {
            points
                .extend(scan.detections.iter().flatten().map(|detection| detection.moved(vehicle_from_scan)));
        }
        let index = index_of(points.iter().map(|point| &point.position), elevation);
        let max_variance = points.iter().map(Detection::total_variance).fold(0.0, f64::max);
        Self { points, index, max_variance }
    }

    /// Farther than this, m, every mismatch with the detection is above the cap.
    fn reach(&self, detection: &Detection, cap: f64) -> f64 {
        const ROUNDING: f64 = 1.001;
        cap * distance_per_mismatch(detection.total_variance() + self.max_variance) * ROUNDING
    }

    /// Infinite where the step saw nothing, so that the cap takes its place.
    fn mismatch(&self, association: &mut Association, detection: &Detection) -> f64 {
        let reference = |id: u32| {
            let point = &self.points[id as usize];
            Reference { position: point.position, spread: point.spread() }
        };
        association.mean_mismatch(detection, &detection.position, reference).unwrap_or(f64::INFINITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_mismatches_count_most() {
        // (3 * 1 + 2 * 2 + 1 * 6) / 6
        assert_eq!(sorted_mean(&mut [6.0, 1.0, 2.0]), Some(13.0 / 6.0));
        assert_eq!(sorted_mean(&mut [4.0]), Some(4.0));
        assert_eq!(sorted_mean(&mut []), None);
    }
}
