//! The usual one of many numbers.

/// The value below which this share of them lies, the nearest of few; `None` of none.
pub(super) fn quantile(values: &[i64], share: f64) -> Option<i64> {
    let mut sorted = values.to_vec();
    sorted.sort_unstable();
    sorted.get(((sorted.len() as f64 - 1.0).max(0.0) * share).round() as usize).copied()
}
