//! Ranks, quantiles and medians of values of which some may be no number.

use crate::scene::median;

/// For each value which share of the others is less, in [0, 1]; equal ones count half. `None` where it is no number,
/// and where there are no others.
pub(super) fn ranks(values: &[f64]) -> Vec<Option<f64>> {
    let numbers = values.iter().copied().enumerate().filter(|(_, value)| value.is_finite());
    let mut sorted: Vec<(usize, f64)> = numbers.collect();
    sorted.sort_unstable_by(|(_, a), (_, b)| a.total_cmp(b));
    let others = sorted.len().saturating_sub(1);
    let mut ranks = vec![None; values.len()];
    let mut less = 0;
    for equal in sorted.chunk_by(|(_, a), (_, b)| a == b) {
        let rank = (less as f64 + 0.5 * (equal.len() as f64 - 1.0)) / others as f64;
        equal.iter().for_each(|(row, _)| ranks[*row] = Some(rank).filter(|_| others > 0));
        less += equal.len();
    }
    ranks
}

/// The least value that at least this share of the values doesn't exceed; `None` where there is no number.
pub(super) fn quantile(values: &[f64], share: f64) -> Option<f64> {
    /// One in so many is asked first for twice the share, which is mostly a little more.
    const FEW: usize = 16;
    let few: Vec<f64> = values.iter().copied().step_by(FEW).collect();
    let guess = quantile_guessed(&few, (2.0 * share).min(1.0), f64::INFINITY);
    quantile_guessed(values, share, guess.unwrap_or(f64::INFINITY))
}

/// The same, told the sooner the fewer values lie at or below a guess that is no less than it.
pub(super) fn quantile_guessed(values: &[f64], share: f64, guess: f64) -> Option<f64> {
    let count = values.iter().map(|value| usize::from(value.is_finite())).sum::<usize>();
    let at = (share * count as f64).ceil() as usize;
    let at = at.clamp(1, count.max(1)) - 1;
    let mut few = at_most(values, guess);
    if at >= few.len() {
        few = at_most(values, f64::INFINITY);
    }
    (count > 0).then(|| *few.select_nth_unstable_by(at, f64::total_cmp).1)
}

/// The numbers among the values that are no more than a limit. Some are compared at a time, for mostly none of them is.
fn at_most(values: &[f64], limit: f64) -> Vec<f64> {
    const TOGETHER: usize = 8;
    let mut found = Vec::new();
    for some in values.chunks(TOGETHER) {
        if some.iter().fold(false, |any, value| any | (*value <= limit)) {
            found.extend(some.iter().copied().filter(|value| value.is_finite() && *value <= limit));
        }
    }
    found
}

/// The median of those values that are numbers.
pub(super) fn median_of(values: &[f64]) -> Option<f64> {
    median(values.iter().copied().filter(|value| value.is_finite()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Few different values, so that ties are common; some are no numbers.
    fn value() -> impl Strategy<Value = f64> {
        prop_oneof![4 => (0..12).prop_map(f64::from), 1 => Just(f64::NAN)]
    }

    proptest! {
        #[test]
        fn ranks_are_what_counting_gives(values in prop::collection::vec(value(), 0..30)) {
            for (i, found) in ranks(&values).into_iter().enumerate() {
                let others: Vec<f64> =
                    (0..values.len()).filter(|j| *j != i && values[*j].is_finite()).map(|j| values[j]).collect();
                let points: f64 =
                    others.iter().map(|other| f64::from(u8::from(*other < values[i])) + 0.5 * f64::from(u8::from(*other == values[i]))).sum();
                let expected = (values[i].is_finite() && !others.is_empty()).then(|| points / others.len() as f64);
                prop_assert_eq!(found, expected);
            }
        }

        #[test]
        fn a_quantile_has_its_share_at_or_below(values in prop::collection::vec(value(), 0..40), share in 0.0..1.0, guess in -1.0..13.0) {
            let finite: Vec<f64> = values.iter().copied().filter(|v| v.is_finite()).collect();
            let below = |limit: f64| finite.iter().filter(|v| **v <= limit).count() as f64;
            prop_assert_eq!(quantile_guessed(&values, share, guess), quantile(&values, share));
            match quantile(&values, share) {
                None => prop_assert!(finite.is_empty()),
                Some(found) => {
                    prop_assert!(below(found) >= share * finite.len() as f64 && finite.contains(&found));
                    let less = finite.iter().copied().filter(|v| *v < found).fold(f64::NEG_INFINITY, f64::max);
                    prop_assert!(less == f64::NEG_INFINITY || below(less) < share * finite.len() as f64);
                }
            }
        }
    }

    #[test]
    fn ranks_by_hand() {
        assert_eq!(
            ranks(&[3.0, 1.0, 3.0, f64::NAN, 2.0]),
            [Some(2.5 / 3.0), Some(0.0), Some(2.5 / 3.0), None, Some(1.0 / 3.0)]
        );
        assert_eq!(ranks(&[7.0]), [None]);
        assert_eq!(quantile(&[5.0, 1.0, f64::NAN, 4.0, 2.0], 0.5), Some(2.0));
    }
}
