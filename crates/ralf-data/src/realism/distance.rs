//! How far two distributions are apart.

use serde::Serialize;

/// Fewer values than this on either side say nothing of a distribution.
pub(super) const ENOUGH: usize = 8;

/// The distance between a real distribution and another one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Distance {
    /// 1-Wasserstein: how far values have to be moved on average to turn one distribution into the other, in the
    /// quantity's unit.
    pub wasserstein: f64,
    /// The same over the real one's spread, which is the mean distance of its values from their median: at 1, the other
    /// is as far off as that median alone would be. `None` where all real values are equal.
    pub normalised: Option<f64>,
    /// Kolmogorov-Smirnov: the largest difference between the shares of values below any one number, 0 to 1.
    pub ks: f64,
}

impl Distance {
    /// The distance between two lists of values in ascending order; `None` where one is empty.
    ///
    /// ```
    /// use ralf_data::realism::Distance;
    /// // Each value is moved by 2; the real ones lie (1 + 0 + 1) / 3 about their median.
    /// let found = Distance::between(&[1.0, 2.0, 3.0], &[3.0, 4.0, 5.0]).unwrap();
    /// assert_eq!((found.wasserstein, found.normalised), (2.0, Some(3.0)));
    /// // Below 3, two thirds of the one and nothing of the other.
    /// assert!((found.ks - 2.0 / 3.0).abs() < 1e-12);
    /// ```
    pub fn between(real: &[f32], other: &[f32]) -> Option<Self> {
        let median = f64::from(*real.get(real.len() / 2)?);
        other.first()?;
        let (mut wasserstein, mut ks) = (0.0, 0.0_f64);
        let (mut i, mut j) = (0, 0);
        let mut at = f64::from(real[0].min(other[0]));
        while i < real.len() || j < other.len() {
            let next = smaller(real.get(i), other.get(j));
            let apart = (i as f64 / real.len() as f64 - j as f64 / other.len() as f64).abs();
            wasserstein += apart * (f64::from(next) - at);
            ks = ks.max(apart);
            at = f64::from(next);
            while real.get(i).is_some_and(|value| *value <= next) {
                i += 1;
            }
            while other.get(j).is_some_and(|value| *value <= next) {
                j += 1;
            }
        }
        let spread =
            real.iter().map(|value| (f64::from(*value) - median).abs()).sum::<f64>() / real.len() as f64;
        let normalised = (spread > 0.0).then(|| wasserstein / spread);
        Some(Self { wasserstein, normalised, ks })
    }
}

/// The smaller of two values, one of which is there.
fn smaller(a: Option<&f32>, b: Option<&f32>) -> f32 {
    a.copied().unwrap_or(f32::INFINITY).min(b.copied().unwrap_or(f32::INFINITY))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Half of the real values lie at 0 and half at 4; of the others a quarter lies at 4, so that a quarter of all has
    /// to be moved by 4. The real ones lie 2 about their median on average, for it is 4: (4 + 4 + 0 + 0) / 4.
    #[test]
    fn worked_out_by_hand() {
        let found = Distance::between(&[0.0, 0.0, 4.0, 4.0], &[0.0, 0.0, 0.0, 4.0]).unwrap();
        assert_eq!(found, Distance { wasserstein: 1.0, normalised: Some(0.5), ks: 0.25 });
        assert_eq!(Distance::between(&[], &[1.0]), None);
        assert_eq!(Distance::between(&[1.0], &[]), None);
        let constant = Distance::between(&[3.0, 3.0], &[3.0, 5.0]).unwrap();
        assert_eq!(constant, Distance { wasserstein: 1.0, normalised: None, ks: 0.5 });
    }

    fn values() -> impl Strategy<Value = Vec<f32>> {
        prop::collection::vec(-50_i16..50, 1..40).prop_map(|mut values| {
            values.sort_unstable();
            values.into_iter().map(f32::from).collect()
        })
    }

    proptest! {
        #[test]
        fn what_is_moved_by_a_shift_is_that_far_off(real in values(), shift in 0_i16..20) {
            let moved: Vec<f32> = real.iter().map(|value| value + f32::from(shift)).collect();
            let found = Distance::between(&real, &moved).unwrap();
            prop_assert!((found.wasserstein - f64::from(shift)).abs() < 1e-9);
            prop_assert_eq!(found.ks > 0.0, shift > 0);
        }

        /// Lists of equal length: sorted values are moved to each other; shares are counted at every value.
        #[test]
        fn is_what_counting_gives(a in values(), b in values()) {
            let n = a.len().min(b.len());
            // Evenly thinned, so that both have the same length and stay in order.
            let thin = |values: &[f32]| -> Vec<f32> { (0..n).map(|i| values[i * values.len() / n]).collect() };
            let (a, b) = (thin(&a), thin(&b));
            let found = Distance::between(&a, &b).unwrap();
            let moved: f64 = a.iter().zip(&b).map(|(a, b)| f64::from((a - b).abs())).sum::<f64>() / n as f64;
            prop_assert!((found.wasserstein - moved).abs() < 1e-9);
            let below = |values: &[f32], at: f32| values.iter().filter(|v| **v <= at).count() as f64 / n as f64;
            let ks = a.iter().chain(&b).map(|at| (below(&a, *at) - below(&b, *at)).abs()).fold(0.0, f64::max);
            prop_assert!((found.ks - ks).abs() < 1e-9);
        }
    }
}
