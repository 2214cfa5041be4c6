//! Tracking: what exists reoccurs in the neighbouring radar scans, clutter and noise do not (paper, equation 8;
//! docs/method.md, section 7).

mod consistent;
mod mismatches;
mod moved_cloud;

use crate::config::TrackingConfig;
use crate::scene::{Association, Frame};
use mismatches::Mismatches;
use moved_cloud::MovedCloud;

/// The mismatch `d` of each detection with the neighbouring scans, sorted and weighted; `None` for all where the branch
/// is off or there is no such scan, and for detections without a position. With `tracking.doppler` also for those that
/// none of these scans could have seen.
pub fn match_detections(frame: &Frame, config: &TrackingConfig) -> Vec<Option<f64>> {
    let mut mismatches =
        if config.doppler { consistent::with_agreeing(frame, config) } else { with_nearest(frame, config) };
    (0..frame.scan.len()).map(|i| sorted_mean(mismatches.of(i))).collect()
}

/// The mismatch of each detection with the nearest ones of each neighbouring scan: the paper's.
fn with_nearest(frame: &Frame, config: &TrackingConfig) -> Mismatches {
    let steps = if config.enabled { frame.steps_within(config.scans) } else { &[] };
    let movers = if config.dynamic { frame.movers() } else { Vec::new() };
    let mut mismatches = Mismatches::new(frame.scan.len(), steps.len());
    for step in steps {
        let cloud = MovedCloud::new(step, frame.radar.elevation, config.sources);
        let mut association = Association::new(&cloud.index, frame.radar.elevation, config.neighbours);
        let dt = (step.t_ns - frame.scan.t_ns()) as f64 * 1e-9;
        for (i, detection) in frame.scan.detections.iter().enumerate() {
            let Some(detection) = detection else { continue };
            association.set_reach(cloud.reach(detection, config.max_mismatch));
            let mut d = cloud.mismatch(&mut association, detection);
            if let Some(mover) = movers.get(i).and_then(Option::as_ref) {
                d = d.min(cloud.mismatch(&mut association, &mover.along_ray(dt)));
            }
            mismatches.push(i, d.min(config.max_mismatch));
        }
    }
    mismatches
}

/// `sum c_k d_(k) / sum c_k` over the ascending `d_(k)`, with `c_k = n - k + 1`. `None` where there are none.
fn sorted_mean(mismatches: &mut [f64]) -> Option<f64> {
    mismatches.sort_by(f64::total_cmp);
    let n = mismatches.len();
    let weighted: f64 = mismatches.iter().enumerate().map(|(k, d)| (n - k) as f64 * d).sum();
    (n > 0).then(|| weighted / (n * (n + 1) / 2) as f64)
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
