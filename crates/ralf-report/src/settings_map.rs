//! F1 of plausible detections over alpha and `w_0` (the paper's figure param_selection): the branches' answers are
//! known, so that the fusion alone is done again for each pair.

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

/// Detections with truth by the settings with which they pass: for each alpha by the highest threshold, artifacts apart
/// from plausible ones.
#[derive(Debug, Default)]
pub(crate) struct Passed {
    counts: [[[usize; 2]; STEPS]; STEPS],
    positives: usize,
}

impl Passed {
    /// Fuses the branches' answers again, for each alpha.
    pub(crate) fn add(&mut self, scored: &Scored, truth: bool) {
        self.positives += usize::from(truth);
        if !scored.may_be_papers() {
            return;
        }
        let present = |w: f32| w.is_finite().then_some(f64::from(w));
        for (step, counts) in self.counts.iter_mut().enumerate() {
            let w =
                prioritize(value_at(step), present(scored.w_opt), present(scored.w_tr), scored.gamma.into());
            let highest = (0..STEPS).rev().find(|step| w.is_some_and(|w| w >= value_at(*step)));
            if let Some(step) = highest {
                counts[step][usize::from(truth)] += 1;
            }
        }
    }

    /// The map; `None` where nothing is truly plausible, for F1 has no value then.
    pub(crate) fn map(&self) -> Option<SettingsMap> {
        if self.positives == 0 {
            return None;
        }
        let mut f1 = [[0.0; STEPS]; STEPS];
        for (row, counts) in f1.iter_mut().zip(&self.counts) {
            let [mut fp, mut tp] = [0, 0];
            for (cell, passed) in row.iter_mut().zip(counts).rev() {
                (fp, tp) = (fp + passed[0], tp + passed[1]);
                *cell = (2 * tp) as f64 / (self.positives + tp + fp) as f64;
            }
        }
        Some(SettingsMap { f1 })
    }
}

impl SettingsMap {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn scored(w_opt: f32, w_tr: f32, gamma: f32, flags: u16) -> Scored {
        Scored { w_opt, w_tr, gamma, flags, ..Scored::with(w_opt) }
    }

    /// By hand: an object seen by LiDAR alone, a ghost that tracking follows, a floor detection, one halved by the
    /// bumper.
    #[test]
    fn alpha_weighs_the_branches_and_w_0_cuts() {
        let object = scored(1.0, 0.0, 1.0, 0);
        let ghost = scored(0.0, 1.0, 1.0, 0);
        let floor = scored(0.0, 1.0, 1.0, 1);
        let behind_bumper = scored(1.0, f32::NAN, 2.0, 0);
        let map = |seen: &[(&Scored, bool)]| {
            let mut passed = Passed::default();
            seen.iter().for_each(|(scored, truth)| passed.add(scored, *truth));
            passed.map()
        };
        let found = map(&[(&object, true), (&ghost, false), (&floor, true), (&behind_bumper, true)]).unwrap();
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
        assert!(map(&[(&ghost, false)]).is_none());
    }
}
