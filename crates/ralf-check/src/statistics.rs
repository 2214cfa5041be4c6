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
}
