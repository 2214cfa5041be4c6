//! What the plausibility `w` is worth beyond the label: precision and recall over the threshold, and reliability.

use crate::scored::Scored;

/// Bins of the reliability curve and the histogram.
pub(crate) const BINS: usize = 20;

/// Precision and recall of plausible detections at one threshold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Point {
    /// Share of what is plausible that passes.
    pub(crate) recall: f64,
    /// Share of what passes that is plausible.
    pub(crate) precision: f64,
}

/// One bin of `w`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub(crate) struct Bin {
    /// Detections in it.
    pub(crate) count: usize,
    /// Of these truly plausible, or labelled so.
    pub(crate) plausible: usize,
}

impl Bin {
    /// Counts one more.
    pub(crate) fn add(&mut self, plausible: bool) {
        self.count += 1;
        self.plausible += usize::from(plausible);
    }

    /// The plausible share; `None` of an empty bin.
    pub(crate) fn share(&self) -> Option<f64> {
        (self.count > 0).then(|| self.plausible as f64 / self.count as f64)
    }
}

/// Detections with truth by their plausibility: what is an artifact at any `w` never passes, as in the method.
///
/// Counted in fine steps of `w`, so that memory doesn't grow with the detections: those in one step pass together, and
/// a threshold is told to 1/65,536.
#[derive(Debug, Default)]
pub(crate) struct Ranked {
    /// By step of `w`: artifacts, and what is plausible. Empty until the first is added.
    steps: Vec<[u64; 2]>,
    positives: u64,
}

/// Steps of `w` from 0 to 1.
const W_STEPS: usize = 1 << 16;

impl Ranked {
    pub(crate) fn add(&mut self, scored: &Scored, truth: bool) {
        self.positives += u64::from(truth);
        if !scored.never_passes {
            self.steps.resize(W_STEPS, [0; 2]);
            // What is below 0 or no number lies in the first step.
            let step = (f64::from(scored.w) * W_STEPS as f64) as usize;
            self.steps[step.min(W_STEPS - 1)][usize::from(truth)] += 1;
        }
    }

    /// Precision over recall for every threshold that makes a difference, by rising recall.
    pub(crate) fn precision_recall(&self) -> Vec<Point> {
        let (mut points, mut tp, mut passed) = (Vec::new(), 0, 0);
        if self.positives == 0 {
            return points;
        }
        for [artifacts, plausible] in self.steps.iter().rev().filter(|counts| **counts != [0; 2]) {
            tp += plausible;
            passed += artifacts + plausible;
            let (recall, precision) = (tp as f64 / self.positives as f64, tp as f64 / passed as f64);
            points.push(Point { recall, precision });
        }
        points
    }
}

/// The area under the curve: average precision, the sum of precision times the step in recall.
pub(crate) fn average_precision(points: &[Point]) -> f64 {
    let mut before = 0.0;
    let step = |point: &Point| {
        let area = (point.recall - before) * point.precision;
        before = point.recall;
        area
    };
    points.iter().map(step).sum()
}

/// Of so many points about as many as a chart can show, the last one among them.
pub(crate) fn thinned(points: &[Point], wanted: usize) -> Vec<Point> {
    let every = points.len().div_ceil(wanted.max(1)).max(1);
    let last = points.len().checked_sub(1).filter(|last| last % every != 0);
    points.iter().step_by(every).chain(last.map(|last| &points[last])).copied().collect()
}

/// The bin of a plausibility, from 0 to 1.
pub(crate) fn bin_of(w: f32) -> usize {
    ((f64::from(w) * BINS as f64) as usize).min(BINS - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: 0.9 plausible, then two at 0.5 of which one is, a floor detection that never passes.
    #[test]
    fn ties_pass_together_and_floor_detections_never() {
        let scored = Scored::with;
        let floor = Scored { never_passes: true, ..scored(0.0) };
        let seen = [(scored(0.9), true), (scored(0.5), false), (scored(0.5), true), (floor, true)];
        let ranked = |seen: &[(Scored, bool)]| {
            let mut ranked = Ranked::default();
            seen.iter().for_each(|(scored, truth)| ranked.add(scored, *truth));
            ranked
        };
        let found = ranked(&seen).precision_recall();
        let third = 1.0 / 3.0;
        let expected = [(third, 1.0), (2.0 * third, 2.0 * third)];
        assert_eq!(found.iter().map(|p| (p.recall, p.precision)).collect::<Vec<_>>(), expected);
        assert!((average_precision(&found) - (third + third * 2.0 * third)).abs() < 1e-12);
        assert!(ranked(&[(scored(0.9), false)]).precision_recall().is_empty());
    }

    /// Both ends of `w` and what lies beyond them have their step, and a million detections take no more room than ten.
    #[test]
    fn the_curve_needs_no_more_memory_for_more_detections() {
        let mut ranked = Ranked::default();
        for w in [1.0, 2.0, f32::NAN, -1.0, 0.0].into_iter().cycle().take(1000) {
            ranked.add(&Scored::with(w), w >= 1.0);
        }
        assert_eq!(ranked.steps.len(), W_STEPS);
        let found: Vec<_> = ranked.precision_recall().iter().map(|p| (p.recall, p.precision)).collect();
        assert_eq!(found, [(1.0, 1.0), (1.0, 0.4)]);
    }

    #[test]
    fn thinning_keeps_both_ends() {
        let points: Vec<_> = (0..1000).map(|i| Point { recall: f64::from(i), precision: 1.0 }).collect();
        let found = thinned(&points, 100);
        assert!(found.len() <= 101);
        assert_eq!((found[0].recall, found[found.len() - 1].recall), (0.0, 999.0));
        assert!(thinned(&[], 10).is_empty());
    }

    #[test]
    fn both_ends_of_w_have_their_bin() {
        let mut bins = [Bin::default(); BINS];
        for (w, plausible) in [(0.0, false), (1.0, true), (0.974, false), (0.976, false)] {
            bins[bin_of(w)].add(plausible);
        }
        assert_eq!((bins[0].count, bins[BINS - 1].count), (1, 3));
        assert_eq!(bins[BINS - 1].share(), Some(1.0 / 3.0));
        assert_eq!(bins[5].share(), None);
    }
}
