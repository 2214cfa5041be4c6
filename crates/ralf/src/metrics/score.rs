//! What plausibilities are worth as scores: precision and recall over the threshold, and how far they are from
//! probabilities (docs/method.md, section 9).

use serde::Serialize;
use std::collections::BTreeMap;

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
/// Thresholds are exact as long as there are at most 262,144 of them. Of more, neighbours are put together and
/// pass together, so that memory doesn't grow with the detections: by a part of what `w` is away from the nearer end
/// of its range, for models are sure of most, and crowd there. Neither depends on the order of the detections.
#[derive(Debug, Clone, Default)]
pub struct Ranked {
    /// By step of `w`: artifacts, and what is plausible.
    steps: BTreeMap<u32, [u64; 2]>,
    /// So many of the last bits of a step are left out.
    coarseness: u32,
    positives: u64,
}

/// Steps of `w` that are told apart at most: some 10 MiB.
const MOST_STEPS: usize = 1 << 18;

/// Where on the way from 0 to 1 a `w` lies, as a number that rises with it: all that can be told apart in a table of
/// float32. The distance to the nearer end counts by its exponent, so steps are finer towards both.
fn step(w: f64) -> u32 {
    let half = 0.5_f32.to_bits();
    // What is no number counts as 0.
    let w = if w > 0.0 { w.min(1.0) } else { 0.0 };
    if w < 0.5 { (w as f32).to_bits() } else { 2 * half - ((1.0 - w) as f32).to_bits() }
}

impl Ranked {
    /// Counts one more. `never_passes` tells that it is labelled an artifact whatever `w` is.
    pub fn add(&mut self, w: f64, never_passes: bool, truth: bool) {
        self.positives += u64::from(truth);
        if !never_passes {
            self.steps.entry(step(w) >> self.coarseness).or_default()[usize::from(truth)] += 1;
            while self.steps.len() > MOST_STEPS {
                self.coarsen();
            }
        }
    }

    /// Puts each two neighbours together.
    fn coarsen(&mut self) {
        self.coarseness += 1;
        for (step, [artifacts, plausible]) in std::mem::take(&mut self.steps) {
            let counts = self.steps.entry(step >> 1).or_default();
            *counts = [counts[0] + artifacts, counts[1] + plausible];
        }
    }

    /// Precision over recall for every threshold that makes a difference, by rising recall.
    pub fn precision_recall(&self) -> Vec<RankedPoint> {
        let (mut points, mut tp, mut passed) = (Vec::new(), 0, 0);
        if self.positives == 0 {
            return points;
        }
        for [artifacts, plausible] in self.steps.values().rev() {
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

    /// What lies beyond the ends of `w` counts as its ends, and what is no number as 0.
    #[test]
    fn both_ends_have_their_step() {
        let mut ranked = Ranked::default();
        for w in [1.0, 2.0, f64::NAN, -1.0, 0.0].into_iter().cycle().take(1000) {
            ranked.add(w, false, w >= 1.0);
        }
        let found: Vec<_> = ranked.precision_recall().iter().map(|p| (p.recall, p.precision)).collect();
        assert_eq!(found, [(1.0, 1.0), (1.0, 0.4)]);
    }

    /// Pseudo-random float32 in [0, 1), the same each time.
    fn uniform(count: u32) -> impl Iterator<Item = f32> {
        let mut state = 1_u32;
        std::iter::repeat_with(move || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (state >> 8) as f32 / (1 << 24) as f32
        })
        .take(count as usize)
    }

    /// Sorted by falling `w`, those that tie passing together.
    fn by_sorting(seen: &[(f32, bool)]) -> f64 {
        let mut sorted = seen.to_vec();
        sorted.sort_by(|a, b| b.0.total_cmp(&a.0));
        let positives = seen.iter().filter(|(_, truth)| *truth).count() as f64;
        let (mut sum, mut tp, mut passed) = (0.0, 0.0, 0.0);
        for ties in sorted.chunk_by(|a, b| a.0 == b.0) {
            let plausible = ties.iter().filter(|(_, truth)| *truth).count() as f64;
            (tp, passed) = (tp + plausible, passed + ties.len() as f64);
            sum += plausible / positives * (tp / passed);
        }
        sum
    }

    fn counted(seen: &[(f32, bool)]) -> Ranked {
        let mut ranked = Ranked::default();
        seen.iter().for_each(|(w, truth)| ranked.add((*w).into(), false, *truth));
        ranked
    }

    /// A model is sure of most: an eighth each lies within 1e-6 of an end, in the order of what is true, an eighth
    /// ties, and the rest is spread.
    #[test]
    fn crowds_at_both_ends_are_ranked_as_by_sorting() {
        let chances: Vec<f32> = uniform(40_000).collect();
        let seen: Vec<(f32, bool)> = chances
            .chunks_exact(2)
            .enumerate()
            .map(|(i, chance)| match i % 8 {
                0 => (chance[0] * 1e-6, chance[1] < chance[0]),
                1 => (1.0 - chance[0] * 1e-6, chance[1] > chance[0]),
                2 => (0.25, chance[1] < 0.25),
                _ => (chance[0], chance[1] < chance[0]),
            })
            .collect();
        let found = average_precision(&counted(&seen).precision_recall());
        assert!((found - by_sorting(&seen)).abs() < 1e-9, "{found} {}", by_sorting(&seen));
    }

    #[test]
    fn more_detections_need_no_more_memory_and_their_order_changes_nothing() {
        let chances: Vec<f32> = uniform(1_000_000).collect();
        let mut seen: Vec<(f32, bool)> =
            chances.chunks_exact(2).map(|chance| (chance[0], chance[1] < chance[0])).collect();
        let ranked = counted(&seen);
        assert!(ranked.coarseness > 0 && ranked.steps.len() <= MOST_STEPS);
        let found = average_precision(&ranked.precision_recall());
        assert!((found - by_sorting(&seen)).abs() < 1e-5, "{found} {}", by_sorting(&seen));
        seen.reverse();
        assert_eq!(counted(&seen).precision_recall(), ranked.precision_recall());
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
