//! What values a feature has in some rows.

use ralf::learned::Rows;

/// What is observed of a feature.
pub(super) struct Range {
    /// How many rows have a value.
    pub(super) observed: usize,
    /// What all but a thousandth at either end lie between; `None` where nothing is observed.
    pub(super) bounds: Option<(f32, f32)>,
}

impl Range {
    /// Of the feature at a place of the rows.
    pub(super) fn of(rows: &Rows, place: usize) -> Self {
        let mut values: Vec<f32> =
            (0..rows.len()).map(|row| rows.row(row)[place]).filter(|value| !value.is_nan()).collect();
        values.sort_unstable_by(f32::total_cmp);
        let at =
            |share: f64| values.get(((values.len().max(1) - 1) as f64 * share).round() as usize).copied();
        Self { observed: values.len(), bounds: at(0.001).zip(at(0.999)) }
    }
}
