//! Things in the order of a number, such as a range: which of them lie in an interval?

use std::ops::RangeInclusive;

/// Things in ascending order of a number each; those whose number isn't finite are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Ordered<T> {
    numbers: Vec<f64>,
    things: Vec<T>,
}

impl<T> Ordered<T> {
    /// Orders things by their numbers. Those of equal ones keep their order.
    pub fn new(numbers: impl IntoIterator<Item = f64>, things: impl IntoIterator<Item = T>) -> Self {
        let known = numbers.into_iter().zip(things).filter(|(number, _)| number.is_finite());
        let mut known: Vec<(f64, T)> = known.collect();
        known.sort_by(|(a, _), (b, _)| a.total_cmp(b));
        let (numbers, things) = known.into_iter().unzip();
        Self { numbers, things }
    }

    /// The things whose number is in an interval, in ascending order of these; none of an interval that is no number.
    pub fn within(&self, interval: RangeInclusive<f64>) -> &[T] {
        let first = self.numbers.partition_point(|number| number < interval.start());
        let end = self.numbers.partition_point(|number| number <= interval.end());
        self.things.get(first..end).unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_has_its_ends() {
        let ordered = Ordered::new([3.0, f64::NAN, 1.0, 2.0, 3.0, f64::INFINITY], 0..6);
        assert_eq!(ordered.within(1.0..=2.0), [2, 3]);
        assert_eq!(ordered.within(2.5..=3.0), [0, 4]);
        assert!(ordered.within(3.1..=9.0).is_empty());
        assert!(ordered.within(f64::NAN..=f64::NAN).is_empty() && ordered.within(3.0..=1.0).is_empty());
    }
}
