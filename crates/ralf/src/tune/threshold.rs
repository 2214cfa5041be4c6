//! The best `w0` there is, for given plausibilities.

use super::Objective;
use crate::metrics::Confusion;

/// Plausibilities of detections, and what is true of them.
#[derive(Debug, Clone, Default)]
pub(super) struct Weighed {
    /// `w` and the truth of the detections that a threshold decides on.
    pub(super) decided: Vec<(f64, bool)>,
    /// Floor detections and unobserved ones, which are labelled artifacts whatever the threshold.
    pub(super) silent: Confusion,
}

/// A threshold, and how good it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cut {
    pub(super) threshold: f64,
    pub(super) score: f64,
    /// How far apart the plausibilities on both sides are.
    gap: f64,
}

impl Weighed {
    /// Takes in one detection.
    pub(super) fn add(&mut self, w: Option<f64>, plausible: bool) {
        match w {
            Some(w) => self.decided.push((w, plausible)),
            None => self.silent.add(plausible, false),
        }
    }

    /// The threshold in [0, 1] with the best score; of equally good ones the one in the widest gap, where new detections are least
    /// likely to fall on the wrong side. Sorts the detections.
    pub(super) fn best_cut(&mut self, objective: Objective) -> Cut {
        self.decided.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut counts = self.silent;
        self.decided.iter().for_each(|(_, plausible)| counts.add(*plausible, false));
        let highest = self.decided.first().map_or(0.0, |(w, _)| *w);
        let nothing_plausible = (highest < 1.0).then(|| Cut::between(highest, 1.0, objective.score(&counts)));
        let mut best = nothing_plausible;
        let mut rest = self.decided.as_slice();
        while let Some(&(w, _)) = rest.first() {
            let equal = rest.iter().take_while(|(other, _)| *other == w).count();
            let (group, lower) = rest.split_at(equal);
            group.iter().for_each(|(_, plausible)| turn_plausible(&mut counts, *plausible));
            let next = lower.first().map_or(0.0, |(w, _)| *w);
            let cut = Cut::between(next, w, objective.score(&counts));
            if best.is_none_or(|best| cut.beats(&best)) {
                best = Some(cut);
            }
            rest = lower;
        }
        best.unwrap_or(Cut { threshold: 1.0, score: objective.score(&counts), gap: 0.0 })
    }
}

fn turn_plausible(counts: &mut Confusion, truly: bool) {
    if truly {
        (counts.tp, counts.r#fn) = (counts.tp + 1, counts.r#fn - 1);
    } else {
        (counts.fp, counts.tn) = (counts.fp + 1, counts.tn - 1);
    }
}

impl Cut {
    /// A threshold above `lower` and not above `upper`.
    fn between(lower: f64, upper: f64, score: f64) -> Self {
        Self { threshold: roundest(lower, upper), score, gap: upper - lower }
    }

    fn beats(&self, other: &Self) -> bool {
        self.score > other.score || (self.score == other.score && self.gap > other.gap)
    }
}

/// The number with the fewest decimals in the middle half of `(lower, upper]`, so that people can read it; `upper` where nothing lies
/// in between.
fn roundest(lower: f64, upper: f64) -> f64 {
    let (middle, quarter) = (lower + (upper - lower) / 2.0, (upper - lower) / 4.0);
    let rounded = (1..=17).filter_map(|decimals| format!("{middle:.decimals$}").parse::<f64>().ok());
    let fits = |value: &f64| *value > lower && *value <= upper && (value - middle).abs() <= quarter;
    rounded.into_iter().find(fits).unwrap_or(upper)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn weighed(decided: &[(f64, bool)], silent: Confusion) -> Weighed {
        Weighed { decided: decided.to_vec(), silent }
    }

    fn counts_at(of: &Weighed, threshold: f64) -> Confusion {
        let mut counts = of.silent;
        of.decided.iter().for_each(|(w, plausible)| counts.add(*plausible, *w >= threshold));
        counts
    }

    fn objective() -> impl Strategy<Value = Objective> {
        prop_oneof![
            Just(Objective::F1),
            Just(Objective::Iou),
            Just(Objective::Accuracy),
            (0.05..=1.0).prop_map(Objective::RecallAtPrecision),
        ]
    }

    proptest! {
        /// The labels only change at the plausibilities themselves: those, and 0 and 1, are all thresholds there are.
        #[test]
        fn no_threshold_is_better(
            decided in prop::collection::vec((prop_oneof![0.0..=1.0, Just(0.0), Just(1.0), Just(0.5)], any::<bool>()), 0..40),
            silent in (0..3u64, 0..3u64),
            objective in objective(),
        ) {
            let silent = Confusion { tn: silent.0, r#fn: silent.1, ..Default::default() };
            let mut of = weighed(&decided, silent);
            let best = of.best_cut(objective);
            prop_assert!((0.0..=1.0).contains(&best.threshold));
            prop_assert_eq!(objective.score(&counts_at(&of, best.threshold)), best.score);
            let all = decided.iter().map(|(w, _)| *w).chain([0.0, 1.0]);
            let brute_force = all.map(|w0| objective.score(&counts_at(&of, w0))).fold(f64::NEG_INFINITY, f64::max);
            prop_assert_eq!(best.score, brute_force);
        }
    }

    #[test]
    fn of_equally_good_thresholds_the_widest_gap_is_taken() {
        let of = [(0.9, true), (0.8, true), (0.3, false), (0.2, false)];
        assert_eq!(weighed(&of, Confusion::default()).best_cut(Objective::F1).threshold, 0.6);
        // 0.9 | 0.85 and 0.4 | 0.2 label three of four right.
        let of = [(0.9, true), (0.85, false), (0.4, true), (0.2, false)];
        assert_eq!(weighed(&of, Confusion::default()).best_cut(Objective::Accuracy).threshold, 0.3);
    }

    #[test]
    fn thresholds_are_round_and_inside() {
        assert_eq!(roundest(0.3, 0.8), 0.6);
        assert_eq!(roundest(0.31, 0.32), 0.315);
        assert_eq!(roundest(0.0, 0.0), 0.0);
        let next = f64::from_bits(0.5f64.to_bits() + 1);
        assert_eq!(roundest(0.5, next), next);
    }
}
