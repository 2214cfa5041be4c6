//! Places in the order of one coordinate: which lie in an interval?

use std::ops::RangeInclusive;

/// Indices of a list of values in ascending order of these; those that are no number are left out.
pub(super) struct Ordered {
    indices: Vec<usize>,
    values: Vec<f64>,
}

impl Ordered {
    /// Orders a list of values. Equal ones keep their order.
    pub(super) fn new(values: &[f64]) -> Self {
        let finite = values.iter().copied().enumerate().filter(|(_, value)| value.is_finite());
        let mut sorted: Vec<(usize, f64)> = finite.collect();
        sorted.sort_unstable_by(|(i, a), (j, b)| a.total_cmp(b).then(i.cmp(j)));
        let (indices, values) = sorted.into_iter().unzip();
        Self { indices, values }
    }

    /// The indices of the values in an interval, in ascending order of these; none of an interval that is no number.
    pub(super) fn within(&self, interval: RangeInclusive<f64>) -> &[usize] {
        let first = self.values.partition_point(|value| value < interval.start());
        let end = self.values.partition_point(|value| value <= interval.end());
        self.indices.get(first..end).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_has_its_ends() {
        let ordered = Ordered::new(&[3.0, f64::NAN, 1.0, 2.0, 3.0, f64::INFINITY]);
        assert_eq!(ordered.within(1.0..=2.0), [2, 3]);
        assert_eq!(ordered.within(2.5..=3.0), [0, 4]);
        assert!(ordered.within(3.1..=9.0).is_empty());
        assert!(ordered.within(f64::NAN..=f64::NAN).is_empty() && ordered.within(3.0..=1.0).is_empty());
    }
}
