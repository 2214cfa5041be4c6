//! How soon a queue leads to what is wrong: against the truth.

use crate::error::DataError;
use crate::judge::{Certainty, Comparison, Doubts};
use crate::result::LabelledRun;
use std::cmp::Reverse;
use std::collections::BTreeMap;
use std::path::Path;

/// The shares of the wrong labels that lie in the first scans of a queue.
#[derive(Debug, Clone, PartialEq)]
pub struct QueueCurve {
    /// How many scans.
    pub scans: usize,
    /// How many wrong labels.
    pub errors: u64,
    /// In the first tenth of the scans, in the first two tenths and so on, most expected errors first.
    pub found: [f64; TENTHS],
    /// The same for who knows where the errors are.
    pub ideal: [f64; TENTHS],
    /// Of expected and true errors, by scan; `None` where either is the same everywhere.
    pub correlation: Option<f64>,
}

/// A curve has a point for each tenth of the scans.
pub const TENTHS: usize = 10;

impl QueueCurve {
    /// Of scans with their expected and true number of errors.
    pub fn new(scans: &[(f64, u64)]) -> Self {
        let errors = scans.iter().map(|(_, errors)| errors).sum();
        let mut queue: Vec<&(f64, u64)> = scans.iter().collect();
        queue.sort_by(|a, b| b.0.total_cmp(&a.0));
        let found = shares(queue.iter().map(|(_, errors)| *errors), scans.len(), errors);
        queue.sort_by_key(|(_, errors)| Reverse(*errors));
        let ideal = shares(queue.iter().map(|(_, errors)| *errors), scans.len(), errors);
        Self { scans: scans.len(), errors, found, ideal, correlation: correlation(scans) }
    }

    /// That of a run, over all of its sequences that have truth.
    ///
    /// # Errors
    /// A folder without results, or with damaged ones.
    pub fn of_run(out: &Path, comparison: &Comparison) -> Result<Self, DataError> {
        let run = LabelledRun::open(out)?;
        let certainty = Certainty::of(&run.settings().method);
        let mut expected = BTreeMap::new();
        for record in &run.record().sequences {
            run.table(record)?.each(&Doubts::COLUMNS, |key, table| {
                let doubts = Doubts::of(table, &certainty)?;
                expected
                    .insert((record.name.clone(), key.radar.to_string(), key.scan), doubts.expected_errors);
                Ok::<_, DataError>(())
            })?;
        }
        let of_scan = |(id, counts): &(crate::ScanId, ralf::metrics::Confusion)| {
            let key = (id.sequence.clone(), id.radar.clone(), id.scan as usize);
            (expected.get(&key).copied().unwrap_or(0.0), counts.fp + counts.r#fn)
        };
        Ok(Self::new(&comparison.scans.iter().map(of_scan).collect::<Vec<_>>()))
    }

    /// The share of the scans that the first tenth is, the first two tenths and so on: whole scans, rounded up. Who
    /// looks at them in no order finds this share of the wrong labels. 0 without scans.
    pub fn looked_at(&self) -> [f64; TENTHS] {
        std::array::from_fn(|tenth| first_scans(tenth, self.scans) as f64 / self.scans.max(1) as f64)
    }
}

/// How many scans the first tenths are, one for the number 0.
fn first_scans(tenth: usize, scans: usize) -> usize {
    ((tenth + 1) * scans).div_ceil(TENTHS)
}

/// The share of all errors after each tenth of the scans, rounded up.
fn shares(in_turn: impl Iterator<Item = u64>, scans: usize, all: u64) -> [f64; TENTHS] {
    let mut sums = vec![0];
    for errors in in_turn {
        sums.push(sums[sums.len() - 1] + errors);
    }
    std::array::from_fn(
        |tenth| {
            if all == 0 { 0.0 } else { sums[first_scans(tenth, scans)] as f64 / all as f64 }
        },
    )
}

/// Pearson's.
fn correlation(scans: &[(f64, u64)]) -> Option<f64> {
    let count = scans.len() as f64;
    let pairs = || scans.iter().map(|(expected, errors)| (*expected, *errors as f64));
    let (mean_a, mean_b) =
        (pairs().map(|(a, _)| a).sum::<f64>() / count, pairs().map(|(_, b)| b).sum::<f64>() / count);
    let sum = |of: fn(f64, f64) -> f64| pairs().map(|(a, b)| of(a - mean_a, b - mean_b)).sum::<f64>();
    let found = sum(|a, b| a * b) / (sum(|a, _| a * a) * sum(|_, b| b * b)).sqrt();
    found.is_finite().then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By hand: of ten scans two hold three errors each and one holds two; the queue begins with a wrong guess.
    #[test]
    fn a_curve_counts_what_lies_in_the_first_scans() {
        let mut scans = vec![(0.0, 0); 10];
        (scans[3], scans[5], scans[7], scans[9]) = ((2.0, 3), (9.0, 0), (3.0, 3), (1.0, 2));
        let curve = QueueCurve::new(&scans);
        assert_eq!((curve.scans, curve.errors), (10, 8));
        assert_eq!(curve.found[..4], [0.0, 0.375, 0.75, 1.0]);
        assert_eq!(curve.ideal[..4], [0.375, 0.75, 1.0, 1.0]);
        assert_eq!((curve.found[9], curve.ideal[9]), (1.0, 1.0));
        assert_eq!(curve.looked_at()[..3], [0.1, 0.2, 0.3]);
    }

    #[test]
    fn tenths_of_few_scans_are_the_scans_that_are_looked_at() {
        let curve = QueueCurve::new(&[(3.0, 6), (2.0, 3), (1.0, 3)]);
        assert_eq!((curve.found[0], curve.looked_at()[0]), (0.5, 1.0 / 3.0));
        assert_eq!((curve.found[3], curve.looked_at()[3], curve.looked_at()[9]), (0.75, 2.0 / 3.0, 1.0));
        assert_eq!(QueueCurve::new(&[]).looked_at(), [0.0; TENTHS]);
    }

    #[test]
    fn expectations_that_come_true_correlate() {
        let right: Vec<(f64, u64)> = (0..20).map(|i| (i as f64 * 0.5, i)).collect();
        assert!((QueueCurve::new(&right).correlation.unwrap() - 1.0).abs() < 1e-12);
        assert_eq!(QueueCurve::new(&[(1.0, 2); 3]).correlation, None);
        let nothing = QueueCurve::new(&[]);
        assert_eq!((nothing.errors, nothing.found[9], nothing.correlation), (0, 0.0, None));
    }
}
