//! The confusion matrix: how often each truth met each label.

use serde::Serialize;
use std::iter::Sum;
use std::ops::AddAssign;

/// Detections by truth and label, with plausible as positive: counts, or their means (`f64`) over many scans.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
pub struct Confusion<Count = u64> {
    /// Plausible, and labelled so.
    pub tp: Count,
    /// Artifacts labelled plausible.
    pub fp: Count,
    /// Artifacts, and labelled so.
    pub tn: Count,
    /// Plausible ones labelled artifact.
    pub r#fn: Count,
}

impl Confusion {
    /// Counts one detection.
    pub fn add(&mut self, truly_plausible: bool, labelled_plausible: bool) {
        let cell = match (truly_plausible, labelled_plausible) {
            (true, true) => &mut self.tp,
            (false, true) => &mut self.fp,
            (false, false) => &mut self.tn,
            (true, false) => &mut self.r#fn,
        };
        *cell += 1;
    }

    /// How many detections were counted.
    pub fn total(&self) -> u64 {
        self.tp + self.fp + self.tn + self.r#fn
    }

    /// These counts with artifact as positive.
    pub fn swapped(&self) -> Self {
        Self { tp: self.tn, fp: self.r#fn, tn: self.tp, r#fn: self.fp }
    }
}

impl AddAssign for Confusion {
    fn add_assign(&mut self, other: Self) {
        self.tp += other.tp;
        self.fp += other.fp;
        self.tn += other.tn;
        self.r#fn += other.r#fn;
    }
}

impl Sum for Confusion {
    fn sum<I: Iterator<Item = Self>>(counts: I) -> Self {
        counts.fold(Self::default(), |mut sum, count| {
            sum += count;
            sum
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_detection_is_counted_in_its_cell() {
        let mut counts = Confusion::default();
        let seen = [(true, true), (false, true), (false, true), (false, false), (true, false), (true, true)];
        for (truth, label) in [seen.as_slice(), &[(true, true)]].concat() {
            counts.add(truth, label);
        }
        assert_eq!(counts, Confusion { tp: 3, fp: 2, tn: 1, r#fn: 1 });
        assert_eq!(counts.total(), 7);
        assert_eq!(counts.swapped(), Confusion { tp: 1, fp: 1, tn: 3, r#fn: 2 });
    }
}
