//! The best `w0` there is, for given plausibilities.

use super::Objective;
use super::buckets::{Bucket, buckets, place};
use ralf::metrics::Confusion;

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
    /// Room for so many detections.
    pub(super) fn with_capacity(detections: usize) -> Self {
        Self { decided: Vec::with_capacity(detections), ..Self::default() }
    }

    /// Takes in one detection.
    pub(super) fn add(&mut self, w: Option<f64>, plausible: bool) {
        match w {
            Some(w) => self.decided.push((w, plausible)),
            None => self.silent.add(plausible, false),
        }
    }

    /// What a threshold makes of them.
    pub(super) fn counts_at(&self, threshold: f64) -> Confusion {
        let mut counts = self.silent;
        self.decided.iter().for_each(|(w, plausible)| counts.add(*plausible, *w >= threshold));
        counts
    }

    /// The threshold in [0, 1] with the best score; of equally good ones the one in the widest gap, where new
    /// detections are least likely to fall on the wrong side.
    ///
    /// Exactly what sorting all plausibilities and trying each would find, but only those are sorted that lie in a
    /// bucket within which the best score may be reached: it can't be better there than if all its plausible detections
    /// were above the threshold and all its artifacts below.
    pub(super) fn best_cut(&self, objective: Objective) -> Cut {
        let buckets = buckets(&self.decided);
        let mut below = self.silent;
        for bucket in &buckets {
            (below.r#fn, below.tn) = (below.r#fn + bucket.plausible, below.tn + bucket.artifacts);
        }
        let highest = buckets.iter().rev().find(|bucket| bucket.len() > 0).map_or(0.0, |top| top.highest);
        let nothing_plausible = objective.score(&below);
        let mut best = (highest < 1.0).then(|| Cut::between(highest, 1.0, nothing_plausible));
        let worth = worth_sorting(&buckets, objective, below, best.as_ref());
        let mut sorted: Vec<_> = self.decided.iter().filter(|(w, _)| worth[place(*w)]).copied().collect();
        sorted.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let mut rest = sorted.as_slice();
        let mut counts = below;
        let mut filled = (0..buckets.len()).rev().filter(|place| buckets[*place].len() > 0).peekable();
        while let Some(place) = filled.next() {
            let before = counts;
            counts = turned(counts, &buckets[place]);
            if worth[place] {
                let (own, others) = rest.split_at(buckets[place].len());
                let next = filled.peek().map_or(0.0, |lower| buckets[*lower].highest);
                try_each(own, next, before, objective, &mut best);
                rest = others;
            }
        }
        best.unwrap_or(Cut { threshold: 1.0, score: nothing_plausible, gap: 0.0 })
    }
}

/// The counts when all of a bucket are labelled plausible as well.
fn turned(mut counts: Confusion, bucket: &Bucket) -> Confusion {
    (counts.tp, counts.r#fn) = (counts.tp + bucket.plausible, counts.r#fn - bucket.plausible);
    (counts.fp, counts.tn) = (counts.fp + bucket.artifacts, counts.tn - bucket.artifacts);
    counts
}

/// Within which buckets the best score may be reached. `counts` are those with nothing plausible, `best` is that
/// threshold if there is one.
fn worth_sorting(
    buckets: &[Bucket],
    objective: Objective,
    mut counts: Confusion,
    best: Option<&Cut>,
) -> Vec<bool> {
    let mut reached = best.map_or(f64::NEG_INFINITY, |best| best.score);
    let mut bounds = vec![f64::NEG_INFINITY; buckets.len()];
    for (bucket, bound) in buckets.iter().zip(&mut bounds).rev().filter(|(bucket, _)| bucket.len() > 0) {
        *bound = objective.score(&turned(counts, &Bucket { artifacts: 0, ..*bucket }));
        counts = turned(counts, bucket);
        reached = reached.max(objective.score(&counts));
    }
    bounds.into_iter().map(|bound| bound >= reached).collect()
}

/// Tries the thresholds at each of some sorted plausibilities. `next` is the highest one below them.
fn try_each(
    sorted: &[(f64, bool)],
    next: f64,
    mut counts: Confusion,
    objective: Objective,
    best: &mut Option<Cut>,
) {
    let mut groups = sorted.chunk_by(|a, b| a.0 == b.0).peekable();
    while let Some(group) = groups.next() {
        group.iter().for_each(|(_, plausible)| turn_plausible(&mut counts, *plausible));
        let lower = groups.peek().map_or(next, |lower| lower[0].0);
        let cut = Cut::between(lower, group[0].0, objective.score(&counts));
        if best.is_none_or(|best| cut.beats(&best)) {
            *best = Some(cut);
        }
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

/// The number with the fewest decimals in the middle half of `(lower, upper]`, so that people can read it; `upper`
/// where nothing lies in between.
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
            let of = weighed(&decided, silent);
            let best = of.best_cut(objective);
            prop_assert!((0.0..=1.0).contains(&best.threshold));
            prop_assert_eq!(objective.score(&of.counts_at(best.threshold)), best.score);
            let all = decided.iter().map(|(w, _)| *w).chain([0.0, 1.0]);
            let brute_force = all.map(|w0| objective.score(&of.counts_at(w0))).fold(f64::NEG_INFINITY, f64::max);
            prop_assert_eq!(best.score, brute_force);
        }
    }

    /// Sorts all of them.
    fn by_sorting(of: &Weighed, objective: Objective) -> Cut {
        let mut sorted = of.decided.clone();
        sorted.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut counts = of.silent;
        sorted.iter().for_each(|(_, plausible)| counts.add(*plausible, false));
        let highest = sorted.first().map_or(0.0, |(w, _)| *w);
        let mut best = (highest < 1.0).then(|| Cut::between(highest, 1.0, objective.score(&counts)));
        try_each(&sorted, 0.0, counts, objective, &mut best);
        best.unwrap()
    }

    proptest! {
        #[test]
        fn buckets_change_nothing(
            decided in prop::collection::vec(((0..400u32, 0..3i32).prop_map(|(w, e)| f64::from(w) / 400.0 * 10.0_f64.powi(-4 * e)), any::<bool>()), 1..600),
            objective in objective(),
        ) {
            let of = weighed(&decided, Confusion { tn: 3, r#fn: 2, ..Default::default() });
            prop_assert_eq!(of.best_cut(objective), by_sorting(&of, objective));
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
