//! Robust figures of small lists.

/// A location and how well it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Estimate {
    /// The median.
    pub(crate) value: f64,
    /// Its standard error: `1.2533 * 1.4826 * MAD / sqrt(n)`, that of a median of normal values.
    pub(crate) error: f64,
}

/// The value below which a share of the values lies; `None` of no values. Values that are no numbers are left out.
pub(crate) fn quantile(values: &[f64], share: f64) -> Option<f64> {
    let mut sorted: Vec<f64> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    sorted.sort_by(f64::total_cmp);
    let last = sorted.len().checked_sub(1)?;
    Some(sorted[(last as f64 * share).round() as usize])
}

/// The middle value.
pub(crate) fn median(values: &[f64]) -> Option<f64> {
    quantile(values, 0.5)
}

/// The median with its standard error.
pub(crate) fn estimate(values: &[f64]) -> Option<Estimate> {
    let value = median(values)?;
    let off: Vec<f64> = values.iter().map(|v| (v - value).abs()).collect();
    let spread = 1.4826 * median(&off)?;
    Some(Estimate { value, error: 1.2533 * spread / (values.len() as f64).sqrt() })
}

/// The mean of differences of pairs, in standard errors of that mean; 0 where fewer than three are given.
pub(crate) fn paired_sigmas(differences: &[f64]) -> f64 {
    let n = differences.len() as f64;
    if differences.len() < 3 {
        return 0.0;
    }
    let mean = differences.iter().sum::<f64>() / n;
    let variance = differences.iter().map(|d| (d - mean).powi(2)).sum::<f64>() / (n - 1.0);
    if variance > 0.0 { mean / (variance / n).sqrt() } else { mean.signum() * f64::from(mean != 0.0) * 1e3 }
}

/// Spearman's rank correlation of pairs, equal values having their mean rank; 0 where either side is one value.
pub(crate) fn rank_correlation(pairs: &[[f64; 2]]) -> f64 {
    let [own, other] = [0, 1].map(|side| ranks(pairs.iter().map(|pair| pair[side])));
    let middle = (pairs.len() as f64 - 1.0) / 2.0;
    let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| (a - middle) * (b - middle)).sum::<f64>();
    let spread = (sum(&own, &own) * sum(&other, &other)).sqrt();
    if spread > 0.0 { sum(&own, &other) / spread } else { 0.0 }
}

fn ranks(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let values: Vec<f64> = values.collect();
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    let mut first = 0;
    for alike in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let rank = first as f64 + (alike.len() as f64 - 1.0) / 2.0;
        alike.iter().for_each(|place| ranks[*place] = rank);
        first += alike.len();
    }
    ranks
}

/// An angle brought into -pi..pi.
pub(crate) fn wrapped(angle: f64) -> f64 {
    angle.sin().atan2(angle.cos())
}

/// The median of angles (rad) that may lie about +-pi: taken about their mean direction.
pub(crate) fn angle_estimate(angles: &[f64]) -> Option<Estimate> {
    let (sin, cos) = angles.iter().fold((0.0, 0.0), |(s, c), a| (s + a.sin(), c + a.cos()));
    let middle = f64::atan2(sin, cos);
    let about: Vec<f64> = angles.iter().map(|a| wrapped(a - middle)).collect();
    let found = estimate(&about)?;
    Some(Estimate { value: wrapped(middle + found.value), error: found.error })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn an_outlier_moves_no_median() {
        let found = estimate(&[1.0, 1.1, 0.9, 1.0, 99.0]).unwrap();
        assert_eq!(found.value, 1.0);
        assert!(found.error < 0.1);
        assert!(estimate(&[]).is_none());
    }

    #[test]
    fn angles_about_half_a_turn_have_a_median_there() {
        let found = angle_estimate(&[PI - 0.02, -PI + 0.02, PI]).unwrap();
        assert!(wrapped(found.value - PI).abs() < 1e-12, "{found:?}");
    }

    #[test]
    fn a_constant_gain_is_certain_and_none_is_nothing() {
        assert!(paired_sigmas(&[0.5; 9]) > 100.0);
        assert_eq!(paired_sigmas(&[0.0; 9]), 0.0);
        assert_eq!(paired_sigmas(&[1.0, 2.0]), 0.0);
    }

    #[test]
    fn ranks_tell_order_alone_and_equal_values_share_theirs() {
        let of = |values: &[f64]| {
            let pairs: Vec<[f64; 2]> = values.iter().enumerate().map(|(i, v)| [*v, i as f64]).collect();
            rank_correlation(&pairs)
        };
        assert!((of(&[1.0, 2.0, 900.0, 901.0]) - 1.0).abs() < 1e-12);
        assert!((of(&[9.0, 3.0, -2.0]) + 1.0).abs() < 1e-12);
        // Ranks 0.5, 0.5, 2 beside 0, 1, 2: 1.5 / sqrt(1.5 * 2).
        assert!((of(&[4.0, 4.0, 7.0]) - 1.5 / 3.0_f64.sqrt()).abs() < 1e-12);
        assert_eq!((of(&[5.0; 4]), of(&[])), (0.0, 0.0));
    }
}
