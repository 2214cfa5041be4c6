//! Columns in the making.

use super::{Feature, Values};

/// So many columns of a scan in which nothing has been observed yet.
pub(super) fn unobserved(features: &[Feature], detections: usize) -> Vec<Values> {
    vec![vec![None; detections]; features.len()]
}

/// Sets a detection's value in every column.
pub(super) fn set<const N: usize>(columns: &mut [Values], detection: usize, values: [Option<f64>; N]) {
    debug_assert_eq!(columns.len(), N);
    for (column, value) in columns.iter_mut().zip(values) {
        column[detection] = value;
    }
}
