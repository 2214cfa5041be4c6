//! Metrics of many scans: their mean, as the paper's table shows, and the metrics of the pooled counts.

use super::{Confusion, Rates, ScoreWorth};
use serde::Serialize;
use std::collections::BTreeMap;

/// Metrics beside the counts that they come from: whole numbers of pooled scans, means of averaged ones.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Metrics<Count = u64> {
    /// Accuracy and all that follows.
    #[serde(flatten)]
    pub rates: Rates,
    /// The confusion matrix.
    #[serde(flatten)]
    pub counts: Confusion<Count>,
}

impl Metrics {
    /// The metrics of one confusion matrix.
    pub fn new(counts: Confusion) -> Self {
        Self { rates: Rates::new(&counts), counts }
    }
}

impl Metrics<f64> {
    /// Every metric's mean over the scans that have it; every count's mean over all scans, 0 where there are none.
    fn mean(scans: &[Confusion]) -> Self {
        let pooled: Confusion = scans.iter().copied().sum();
        let mean = |sum: u64| sum as f64 / scans.len().max(1) as f64;
        let Confusion { tp, fp, tn, r#fn } = pooled;
        Self {
            rates: Rates::mean(scans.iter().map(Rates::new)),
            counts: Confusion { tp: mean(tp), fp: mean(fp), tn: mean(tn), r#fn: mean(r#fn) },
        }
    }
}

/// Both ways to sum up many scans.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Scores {
    /// Mean over the scans: what the paper's table shows.
    pub scan_mean: Metrics<f64>,
    /// The metrics of all scans' counts together.
    pub pooled: Metrics,
}

impl Scores {
    /// The scores of some scans.
    pub fn from_scans(scans: &[Confusion]) -> Self {
        Self { scan_mean: Metrics::mean(scans), pooled: Metrics::new(scans.iter().copied().sum()) }
    }
}

/// The scores of one sequence.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SequenceScores {
    /// How many scans were compared.
    pub scans: usize,
    /// What came out.
    #[serde(flatten)]
    pub scores: Scores,
}

/// The result of comparing labels with the truth: what `ralf evaluate --json` prints.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Evaluation {
    /// Over all scans of all sequences.
    pub overall: Scores,
    /// The scores of each sequence that has truth, by name.
    pub sequences: BTreeMap<String, SequenceScores>,
    /// What plausibilities are worth, all detections together, where there are any beside the labels.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plausibility: Option<ScoreWorth>,
}

impl Evaluation {
    /// Sums up scans, each given with the name of its sequence.
    pub fn from_scans<'a>(scans: impl IntoIterator<Item = (&'a str, Confusion)>) -> Self {
        let mut by_sequence: BTreeMap<&str, Vec<Confusion>> = BTreeMap::new();
        for (sequence, counts) in scans {
            by_sequence.entry(sequence).or_default().push(counts);
        }
        let all: Vec<Confusion> = by_sequence.values().flatten().copied().collect();
        let scored = |(name, scans): (&str, Vec<Confusion>)| {
            (name.to_owned(), SequenceScores { scans: scans.len(), scores: Scores::from_scans(&scans) })
        };
        let sequences = by_sequence.into_iter().map(scored).collect();
        Self { overall: Scores::from_scans(&all), sequences, plausibility: None }
    }

    /// How many scans were compared.
    pub fn scans(&self) -> usize {
        self.sequences.values().map(|sequence| sequence.scans).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn counts([tp, fp, tn, missed]: [u64; 4]) -> Confusion {
        Confusion { tp, fp, tn, r#fn: missed }
    }

    /// By hand: sequence 00 has two scans, of which the second holds no artifacts; 01 has one.
    fn example() -> Evaluation {
        let scans = [("00", [1, 0, 1, 0]), ("01", [1, 1, 1, 1]), ("00", [3, 0, 0, 1])];
        Evaluation::from_scans(scans.map(|(name, cells)| (name, counts(cells))))
    }

    #[test]
    fn overall_is_the_mean_over_scans_and_not_over_sequences() {
        let found = example();
        assert_eq!(found.scans(), 3);
        assert_eq!(found.overall.scan_mean.rates.accuracy, Some((1.0 + 0.75 + 0.5) / 3.0));
        assert_eq!(found.overall.pooled.rates.accuracy, Some(0.7));
        // Two of the three scans hold artifacts.
        assert_eq!(found.overall.scan_mean.rates.f1_artifact, Some(0.75));
        assert_eq!(found.overall.scan_mean.counts.tp, 5.0 / 3.0);
        let first = &found.sequences["00"];
        assert_eq!((first.scans, first.scores.scan_mean.rates.iou_artifact), (2, Some(1.0)));
        assert_eq!(first.scores.pooled.counts, counts([4, 0, 1, 1]));
    }

    proptest! {
        #[test]
        fn pooled_is_of_the_sums_and_the_order_of_scans_is_of_no_matter(
            scans in proptest::collection::vec(proptest::array::uniform4(0..50u64), 0..20)
        ) {
            let mut scans: Vec<Confusion> = scans.into_iter().map(counts).collect();
            let scores = Scores::from_scans(&scans);
            prop_assert_eq!(scores.pooled, Metrics::new(scans.iter().copied().sum()));
            scans.reverse();
            let reversed = Scores::from_scans(&scans);
            prop_assert_eq!(scores.pooled, reversed.pooled);
            prop_assert_eq!(scores.scan_mean.counts, reversed.scan_mean.counts);
            let accuracy = |s: Scores| s.scan_mean.rates.accuracy.unwrap_or(0.0);
            prop_assert!((accuracy(scores) - accuracy(reversed)).abs() < 1e-12);
        }

        #[test]
        fn equal_scans_have_their_own_value_as_mean(cells in proptest::array::uniform4(0..50u64)) {
            let one = Rates::new(&counts(cells));
            let mean = Scores::from_scans(&[counts(cells); 2]).scan_mean;
            prop_assert_eq!(mean.rates, one);
        }
    }
}
