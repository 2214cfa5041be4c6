//! Features as bins of about as many rows each.

use ralf::learned::Rows;

/// Bins of values; one more holds what is absent.
pub(super) const MOST: usize = 63;
/// The bin of what is absent.
pub(super) const ABSENT: u8 = MOST as u8;
/// All bins.
pub(super) const ALL: usize = MOST + 1;

/// Every feature of a table in bins.
#[derive(Debug, Clone, PartialEq)]
pub struct Bins {
    columns: Vec<Column>,
}

/// One feature.
#[derive(Debug, Clone, PartialEq)]
struct Column {
    /// The bin of each row.
    codes: Vec<u8>,
    /// Between the bins: bin `i` holds values at most `edges[i]`.
    edges: Vec<f32>,
}

impl Bins {
    /// The bins of a table.
    pub fn new(rows: &Rows) -> Self {
        let mut columns = Vec::with_capacity(rows.width());
        for feature in 0..rows.width() {
            let values: Vec<f32> = (0..rows.len()).map(|row| rows.row(row)[feature]).collect();
            let edges = edges(&values);
            let codes = values.iter().map(|value| code(&edges, *value)).collect();
            columns.push(Column { codes, edges });
        }
        Self { columns }
    }

    /// The bin of each row.
    pub(super) fn codes(&self, feature: usize) -> &[u8] {
        &self.columns[feature].codes
    }

    /// Between the bins, from low to high.
    pub(super) fn edges(&self, feature: usize) -> &[f32] {
        &self.columns[feature].edges
    }
}

fn code(edges: &[f32], value: f32) -> u8 {
    if value.is_nan() { ABSENT } else { edges.partition_point(|edge| *edge < value) as u8 }
}

/// Edges half-way between different values, such that the bins hold about as many rows each.
fn edges(values: &[f32]) -> Vec<f32> {
    let mut sorted: Vec<f32> = values.iter().copied().filter(|value| !value.is_nan()).collect();
    sorted.sort_unstable_by(f32::total_cmp);
    let mut edges: Vec<f32> = Vec::new();
    let mut begin = 0;
    while let Some(rest) = sorted.get(begin..).filter(|rest| !rest.is_empty()) {
        let size = rest.len().div_ceil(MOST - edges.len());
        let last = rest[size - 1];
        let next = begin + rest.partition_point(|value| *value <= last);
        let Some(after) = sorted.get(next) else { break };
        let middle = last + (after - last) / 2.0;
        // Half-way between neighbouring numbers may be the upper one.
        edges.push(if middle < *after && middle.is_finite() { middle } else { last });
        begin = next;
    }
    edges
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_values_have_a_bin_each_and_many_share_them_evenly() {
        let few = edges(&[3.0, 1.0, f32::NAN, 1.0, 2.0]);
        assert_eq!(few, [1.5, 2.5]);
        assert_eq!([1.0, 1.5, 1.6, 9.0, f32::NAN].map(|value| code(&few, value)), [0, 0, 1, 2, ABSENT]);
        let many: Vec<f32> = (0..6300).map(|i| i as f32).collect();
        let edges = edges(&many);
        assert_eq!(edges.len(), MOST - 1);
        for bin in 0..MOST as u8 {
            assert_eq!(many.iter().filter(|value| code(&edges, **value) == bin).count(), 100);
        }
    }

    #[test]
    fn odd_columns_have_bins_too() {
        assert!(edges(&[]).is_empty());
        assert!(edges(&[f32::NAN, f32::NAN]).is_empty());
        assert!(edges(&[7.0; 9]).is_empty());
        let neighbours = edges(&[1.0, f32::from_bits(1.0_f32.to_bits() + 1)]);
        assert_eq!(neighbours, [1.0]);
        let far = edges(&[f32::MIN, f32::MAX]);
        assert!(far.len() == 1 && far[0].is_finite() && far[0] < f32::MAX);
        // One value that most rows have doesn't use up the bins of the others.
        let mut zeros = vec![0.0; 10_000];
        zeros.extend((1..=500).map(|i| i as f32));
        assert!(edges(&zeros).len() > 50, "{}", edges(&zeros).len());
    }
}
