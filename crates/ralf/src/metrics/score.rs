//! What plausibilities are worth as scores: precision and recall over the threshold, and how far they are from
//! probabilities (docs/method.md, section 9).

use serde::Serialize;

/// Precision and recall of plausible detections at one threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RankedPoint {
    /// Share of what is plausible that passes.
    pub recall: f64,
    /// Share of what passes that is plausible.
    pub precision: f64,
}

/// What plausibilities `w` are worth; `None` where that has no meaning.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct ScoreWorth {
    /// The area under precision over recall: what is an artifact at any `w`, such as a floor detection of the paper's
    /// method, never passes.
    pub average_precision: Option<f64>,
    /// By how much `w` is off as a probability, on average.
    pub calibration_error: Option<f64>,
}

/// Detections whose truth is known, with their plausibilities: all that [`ScoreWorth`] needs.
#[derive(Debug, Clone, Default)]
pub struct ScoredDetections {
    ranked: Ranked,
    reliability: Reliability,
}

impl ScoredDetections {
    /// Counts one more. `never_passes` tells that it is labelled an artifact whatever `w` is.
    pub fn add(&mut self, w: f64, never_passes: bool, plausible: bool) {
        self.ranked.add(w, never_passes, plausible);
        self.reliability.add(w, plausible);
    }

    /// What they are worth.
    pub fn worth(&self) -> ScoreWorth {
        let points = self.ranked.precision_recall();
        let average_precision = (self.ranked.positives > 0).then(|| average_precision(&points));
        ScoreWorth { average_precision, calibration_error: self.reliability.error() }
    }
}

/// Cells of [`Reliability`].
const CELLS: usize = 15;

/// How far probabilities are from what is true, by cells of equal width.
#[derive(Debug, Clone, Default)]
pub struct Reliability {
    /// Of each cell the sum of probabilities, and what is plausible.
    cells: [(f64, f64); CELLS],
    count: usize,
}

impl Reliability {
    /// Counts one more; what is no number is not counted.
    pub fn add(&mut self, probability: f64, plausible: bool) {
        if probability.is_nan() {
            return;
        }
        let cell = &mut self.cells[((probability * CELLS as f64) as usize).min(CELLS - 1)];
        cell.0 += probability;
        cell.1 += if plausible { 1.0 } else { 0.0 };
        self.count += 1;
    }

    /// By how much they are off, on average (expected calibration error); `None` of nothing.
    pub fn error(&self) -> Option<f64> {
        let off = self.cells.iter().map(|(said, was)| (said - was).abs()).sum::<f64>();
        (self.count > 0).then(|| off / self.count as f64)
    }
}

/// Detections with truth by their plausibility: what is an artifact at any `w` never passes, as in the method.
///
/// Counted in fine steps of `w`, so that memory doesn't grow with the detections: those in one step pass together, and
/// a threshold is told to 1/65,536.
#[derive(Debug, Clone, Default)]
pub struct Ranked {
    /// By step of `w`: artifacts, and what is plausible. Empty until the first is added.
    steps: Vec<[u64; 2]>,
    positives: u64,
}

/// Steps of `w` from 0 to 1.
const W_STEPS: usize = 1 << 16;

impl Ranked {
    /// Counts one more. `never_passes` tells that it is labelled an artifact whatever `w` is.
    pub fn add(&mut self, w: f64, never_passes: bool, truth: bool) {
        self.positives += u64::from(truth);
        if !never_passes {
            self.steps.resize(W_STEPS, [0; 2]);
            // What is below 0 or no number lies in the first step.
            let step = (w * W_STEPS as f64) as usize;
            self.steps[step.min(W_STEPS - 1)][usize::from(truth)] += 1;
        }
    }

    /// Precision over recall for every threshold that makes a difference, by rising recall.
    pub fn precision_recall(&self) -> Vec<RankedPoint> {
        let (mut points, mut tp, mut passed) = (Vec::new(), 0, 0);
        if self.positives == 0 {
            return points;
        }
        for [artifacts, plausible] in self.steps.iter().rev().filter(|counts| **counts != [0; 2]) {
            tp += plausible;
            passed += artifacts + plausible;
            let (recall, precision) = (tp as f64 / self.positives as f64, tp as f64 / passed as f64);
            points.push(RankedPoint { recall, precision });
        }
        points
    }
}

/// The area under the curve: average precision, the sum of precision times the step in recall.
pub fn average_precision(points: &[RankedPoint]) -> f64 {
    let mut before = 0.0;
    let step = |point: &RankedPoint| {
        let area = (point.recall - before) * point.precision;
        before = point.recall;
        area
    };
    points.iter().map(step).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 0.9 plausible, then two at 0.5 of which one is, a floor detection that never passes.
    #[test]
    fn ties_pass_together_and_floor_detections_never() {
        let seen = [(0.9, false, true), (0.5, false, false), (0.5, false, true), (0.0, true, true)];
        let ranked = |seen: &[(f64, bool, bool)]| {
            let mut ranked = Ranked::default();
            seen.iter().for_each(|(w, never_passes, truth)| ranked.add(*w, *never_passes, *truth));
            ranked
        };
        let found = ranked(&seen).precision_recall();
        let third = 1.0 / 3.0;
        let expected = [(third, 1.0), (2.0 * third, 2.0 * third)];
        assert_eq!(found.iter().map(|p| (p.recall, p.precision)).collect::<Vec<_>>(), expected);
        assert!((average_precision(&found) - (third + third * 2.0 * third)).abs() < 1e-12);
        assert!(ranked(&[(0.9, false, false)]).precision_recall().is_empty());
    }

    /// Both ends of `w` and what lies beyond them have their step, and a million detections take no more room than ten.
    #[test]
    fn the_curve_needs_no_more_memory_for_more_detections() {
        let mut ranked = Ranked::default();
        for w in [1.0, 2.0, f64::NAN, -1.0, 0.0].into_iter().cycle().take(1000) {
            ranked.add(w, false, w >= 1.0);
        }
        assert_eq!(ranked.steps.len(), W_STEPS);
        let found: Vec<_> = ranked.precision_recall().iter().map(|p| (p.recall, p.precision)).collect();
        assert_eq!(found, [(1.0, 1.0), (1.0, 0.4)]);
    }

    #[test]
    fn both_figures_of_some_detections() {
        let mut seen = ScoredDetections::default();
        assert_eq!(seen.worth(), ScoreWorth::default());
        // A floor detection is missed by any threshold, and its probability counts all the same.
        for (w, never_passes, plausible) in [(0.9, false, true), (0.5, false, false), (0.7, true, true)] {
            seen.add(w, never_passes, plausible);
        }
        let ScoreWorth { average_precision, calibration_error } = seen.worth();
        assert!((average_precision.unwrap() - 0.5).abs() < 1e-12);
        assert!((calibration_error.unwrap() - (0.1 + 0.5 + 0.3) / 3.0).abs() < 1e-12);
    }
}
