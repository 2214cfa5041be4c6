//! Echoes of one range: what a radar sees depends on how far away it looks.

use super::Values;
use crate::scene::Ordered;
use std::collections::BTreeMap;

/// Echoes whose range differs by at most this stand in the same clutter, m.
const REACH: f64 = 5.0;

/// Values of the echoes of some scans by their range.
pub(super) struct Rings<'a> {
    scans: Vec<&'a Ordered<f64>>,
}

impl<'a> Rings<'a> {
    pub(super) fn new(scans: impl Iterator<Item = &'a Ordered<f64>>) -> Self {
        Self { scans: scans.collect() }
    }

    /// For each of some values, at its range, how far it is above the level of its ring: the echoes that are within 5 m
    /// of the whole metre nearest to that range. Every metre's level is worked out once, from near to far; `level` is
    /// told of the one before.
    pub(super) fn over(
        &self,
        values: &[f64],
        ranges: &[f64],
        level: impl Fn(&[f64], Option<f64>) -> Option<f64>,
    ) -> Values {
        // A cast holds at the ends, and takes what is no number to 0.
        let metres: Vec<i64> = ranges.iter().map(|range| range.round() as i64).collect();
        let mut levels: BTreeMap<i64, Option<f64>> = metres.iter().map(|metre| (*metre, None)).collect();
        let mut before = None;
        for (metre, known) in &mut levels {
            *known = level(&self.ring(*metre as f64), before);
            before = known.or(before);
        }
        let mut over = Vec::with_capacity(values.len());
        for ((value, range), metre) in values.iter().zip(ranges).zip(&metres) {
            let found = levels.get(metre).copied().flatten().map(|level| value - level);
            over.push(found.filter(|found| found.is_finite() && range.is_finite()));
        }
        over
    }

    fn ring(&self, middle: f64) -> Vec<f64> {
        let of_scans = self.scans.iter().map(|scan| scan.within(middle - REACH..=middle + REACH));
        of_scans.collect::<Vec<_>>().concat()
    }
}

#[cfg(test)]
mod tests {
    use super::super::statistics::median_of;
    use super::*;
    use proptest::prelude::*;

    /// Few different values, so that ties are common; some are no numbers.
    fn value() -> impl Strategy<Value = f64> {
        prop_oneof![4 => (0..48).prop_map(|v| 0.5 * f64::from(v)), 1 => Just(f64::NAN)]
    }

    proptest! {
        #[test]
        fn the_median_of_a_ring_is_what_looking_at_all_gives(
            rows in prop::collection::vec((value(), value()), 0..40), first in 0usize..40,
        ) {
            let (values, ranges): (Vec<f64>, Vec<f64>) = rows.into_iter().unzip();
            let first = first.min(values.len());
            let scans = [0..first, first..values.len()];
            let scans = scans.map(|rows| Ordered::new(ranges[rows.clone()].iter().copied(), values[rows].iter().copied()));
            let found = Rings::new(scans.iter()).over(&values, &ranges, |ring, _| median_of(ring));
            for (i, found) in found.into_iter().enumerate() {
                let near = |j: &usize| (ranges[*j] - ranges[i].round()).abs() <= REACH;
                let ring: Vec<f64> = (0..values.len()).filter(near).map(|j| values[j]).collect();
                let expected = median_of(&ring).map(|median| values[i] - median);
                prop_assert_eq!(found, expected.filter(|over| over.is_finite()));
            }
        }
    }
}
