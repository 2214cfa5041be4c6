//! F1 of plausible detections over alpha and `w_0` (the paper's figure param_selection): the branches' answers are known, so
//! that the fusion alone is done again for each pair.

use crate::scored::Scored;
use ralf::paper::prioritize;

/// Values of each setting, evenly from 0 to 1.
pub(crate) const STEPS: usize = 21;

/// F1 by alpha (first index) and threshold.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct SettingsMap {
    /// Of all detections with truth together.
    pub(crate) f1: [[f64; STEPS]; STEPS],
}

/// The value of a step.
pub(crate) fn value_at(step: usize) -> f64 {
    step as f64 / (STEPS - 1) as f64
}

impl SettingsMap {
    /// `None` where nothing is truly plausible, for F1 has no value then.
    pub(crate) fn of(detections: &[(&Scored, bool)]) -> Option<Self> {
        let positives = detections.iter().filter(|(_, truth)| *truth).count();
        (positives > 0).then(|| {
            let mut f1 = [[0.0; STEPS]; STEPS];
            for (step, row) in f1.iter_mut().enumerate() {
                *row = over_thresholds(detections, value_at(step), positives);
            }
            Self { f1 }
        })
    }

    /// The best pair: alpha, `w_0`, F1. Of equal ones the first.
    pub(crate) fn best(&self) -> (f64, f64, f64) {
        let mut best = (0.0, 0.0, f64::NEG_INFINITY);
        for (alpha, row) in self.f1.iter().enumerate() {
            for (threshold, f1) in row.iter().enumerate() {
                if *f1 > best.2 {
                    best = (value_at(alpha), value_at(threshold), *f1);
                }
            }
        }
        best
    }
}

/// F1 for every threshold: detections are counted by the highest threshold that they pass.
fn over_thresholds(detections: &[(&Scored, bool)], alpha: f64, positives: usize) -> [f64; STEPS] {
    let mut passed = [[0_usize; 2]; STEPS];
    for (scored, truth) in detections.iter().filter(|(scored, _)| scored.may_be_plausible()) {
        let present = |w: f32| w.is_finite().then_some(f64::from(w));
        let w = prioritize(alpha, present(scored.w_opt), present(scored.w_tr), scored.gamma.into());
        let highest = (0..STEPS).rev().find(|step| w.is_some_and(|w| w >= value_at(*step)));
        if let Some(step) = highest {
            passed[step][usize::from(*truth)] += 1;
        }
    }
    let mut f1 = [0.0; STEPS];
    let [mut fp, mut tp] = [0, 0];
    for (step, counts) in passed.iter().enumerate().rev() {
        (fp, tp) = (fp + counts[0], tp + counts[1]);
        f1[step] = (2 * tp) as f64 / (positives + tp + fp) as f64;
    }
    f1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scored(w_opt: f32, w_tr: f32, gamma: f32, flags: u16) -> Scored {
        let (range, azimuth, w) = (10.0, 0.0, 0.0);
        Scored { range, azimuth, w_opt, w_tr, w, gamma, plausible: false, flags, truth: None, cause: None }
    }

    /// By hand: an object seen by LiDAR alone, a ghost that tracking follows, a floor detection, one halved by the bumper.
    #[test]
    fn alpha_weighs_the_branches_and_w_0_cuts() {
        let object = scored(1.0, 0.0, 1.0, 0);
        let ghost = scored(0.0, 1.0, 1.0, 0);
        let floor = scored(0.0, 1.0, 1.0, 1);
        let behind_bumper = scored(1.0, f32::NAN, 2.0, 0);
        let found =
            SettingsMap::of(&[(&object, true), (&ghost, false), (&floor, true), (&behind_bumper, true)])
                .unwrap();
        let step = |value: f64| (value * (STEPS - 1) as f64).round() as usize;
        let f1 = |alpha, threshold| found.f1[step(alpha)][step(threshold)];
        // tp 2 of 3, no ghost: 4 / (3 + 2).
        assert_eq!(f1(1.0, 0.5), 0.8);
        // The one behind the bumper has w = 0.5 at any alpha: tp 1, 2 / (3 + 1).
        assert_eq!(f1(1.0, 0.55), 0.5);
        // Tracking alone: the ghost and the one behind the bumper.
        assert_eq!(f1(0.0, 0.5), 2.0 / 5.0);
        assert_eq!(f1(0.0, 1.0), 0.0);
        // At w_0 = 0 all but the floor detection pass.
        assert_eq!(f1(0.5, 0.0), 4.0 / 6.0);
        assert_eq!(found.best().2, 0.8);
        assert!(SettingsMap::of(&[(&ghost, false)]).is_none());
    }
}
