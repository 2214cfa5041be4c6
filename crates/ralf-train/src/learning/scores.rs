//! How good probabilities are, where the truth is known.

use super::table::Known;
use ralf::metrics::Reliability;
use std::fmt;

/// What scores say of some detections; shares in [0, 1]. `None` where they have no meaning.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Scores {
    /// F1 of plausible detections.
    pub f1: Option<f64>,
    /// The mean precision over all recalls (average precision) of the scores alone: what is labelled an artifact
    /// whatever its score is, as floor detections by the paper's method, counts by its score like all others.
    pub average_precision: Option<f64>,
    /// The share that is labelled right.
    pub accuracy: Option<f64>,
    /// By how much probabilities are off, on average (expected calibration error, 15 cells of equal width).
    pub calibration_error: Option<f64>,
}

/// A score with what was true.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scored {
    /// The larger the more plausible.
    pub score: f64,
    /// What is true.
    pub plausible: bool,
}

/// Each score with what is known to be true.
pub(super) fn scored(scores: Vec<f64>, known: &[Known]) -> impl Iterator<Item = Scored> {
    let with_truth = |(score, known): (f64, &Known)| Scored { score, plausible: known.plausible };
    scores.into_iter().zip(known).map(with_truth)
}

impl Scores {
    /// What probabilities are worth whose threshold is known before.
    pub fn new(judged: &[Scored], threshold: f64) -> Self {
        let counts = Counts::at(judged, threshold);
        let all = judged.len() as f64;
        let accuracy = (!judged.is_empty()).then(|| (all - counts.wrong()) / all);
        let mut reliability = Reliability::default();
        judged.iter().for_each(|row| reliability.add(row.score, row.plausible));
        let calibration_error = reliability.error();
        Self { f1: counts.f1(), average_precision: average_precision(judged), accuracy, calibration_error }
    }

    /// The mean over several, each by those that have it.
    pub fn mean(all: &[Self]) -> Self {
        let mean = |of: fn(&Self) -> Option<f64>| {
            let values: Vec<f64> = all.iter().filter_map(of).collect();
            (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
        };
        Self {
            f1: mean(|scores| scores.f1),
            average_precision: mean(|scores| scores.average_precision),
            accuracy: mean(|scores| scores.accuracy),
            calibration_error: mean(|scores| scores.calibration_error),
        }
    }

    /// Those that have a meaning, for a model's file: each with its name behind that of what is measured.
    pub(super) fn told(measured: [(&str, &Self); 2]) -> Vec<(String, String)> {
        let mut scores = Vec::new();
        for (of, measured) in measured {
            for (name, value) in measured.named() {
                scores.extend(value.map(|value| (format!("{of}{name}"), format!("{value:.4}"))));
            }
        }
        scores
    }

    /// Each with its name.
    pub fn named(&self) -> [(&'static str, Option<f64>); 4] {
        [
            ("f1", self.f1),
            ("average_precision", self.average_precision),
            ("accuracy", self.accuracy),
            ("calibration_error", self.calibration_error),
        ]
    }
}

impl fmt::Display for Scores {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (at, (_, value)) in self.named().into_iter().enumerate() {
            let gap = if at > 0 { "  " } else { "" };
            match value {
                Some(value) => write!(f, "{gap}{value:.3}")?,
                None => write!(f, "{gap}    -")?,
            }
        }
        Ok(())
    }
}

/// Detections counted at a threshold.
#[derive(Debug, Clone, Copy, Default)]
struct Counts {
    true_positive: f64,
    false_positive: f64,
    false_negative: f64,
}

impl Counts {
    fn at(judged: &[Scored], threshold: f64) -> Self {
        let mut counts = Self::default();
        for row in judged {
            match (row.score >= threshold, row.plausible) {
                (true, true) => counts.true_positive += 1.0,
                (true, false) => counts.false_positive += 1.0,
                (false, true) => counts.false_negative += 1.0,
                (false, false) => {}
            }
        }
        counts
    }

    fn wrong(&self) -> f64 {
        self.false_positive + self.false_negative
    }

    fn f1(&self) -> Option<f64> {
        let all = 2.0 * self.true_positive + self.wrong();
        (self.true_positive + self.false_negative > 0.0).then(|| 2.0 * self.true_positive / all)
    }
}

/// The threshold at which F1 is largest; the highest of several. 0.5 where nothing is plausible.
pub fn best_threshold(judged: &[Scored]) -> f64 {
    let all_missed = judged.iter().filter(|row| row.plausible).count() as f64;
    let mut counts = Counts { false_negative: all_missed, ..Counts::default() };
    let (mut best, mut threshold) = (0.0, 0.5);
    for group in by_falling_score(judged) {
        for row in group.iter() {
            if row.plausible {
                counts.true_positive += 1.0;
                counts.false_negative -= 1.0;
            } else {
                counts.false_positive += 1.0;
            }
        }
        let f1 = counts.f1().unwrap_or(0.0);
        if f1 > best {
            (best, threshold) = (f1, group[0].score);
        }
    }
    threshold
}

fn average_precision(judged: &[Scored]) -> Option<f64> {
    let all = judged.iter().filter(|row| row.plausible).count() as f64;
    let (mut found, mut seen, mut sum) = (0.0, 0.0, 0.0);
    for group in by_falling_score(judged) {
        let plausible = group.iter().filter(|row| row.plausible).count() as f64;
        found += plausible;
        seen += group.len() as f64;
        sum += plausible * found / seen;
    }
    (all > 0.0).then(|| sum / all)
}

/// Groups of one score, from high to low.
fn by_falling_score(judged: &[Scored]) -> Vec<Vec<Scored>> {
    let mut sorted = judged.to_vec();
    sorted.sort_by(|a, b| b.score.total_cmp(&a.score));
    sorted.chunk_by(|a, b| a.score == b.score).map(<[Scored]>::to_vec).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(rows: &[(f64, bool)]) -> Vec<Scored> {
        rows.iter().map(|(score, plausible)| Scored { score: *score, plausible: *plausible }).collect()
    }

    #[test]
    fn figures_worked_out_by_hand() {
        let rows = judged(&[(0.9, true), (0.8, false), (0.7, true), (0.2, false), (0.1, true)]);
        let scores = Scores::new(&rows, 0.5);
        // 2 right of 3 found, 2 of 3 that there are.
        assert_eq!(scores.f1, Some(2.0 / 3.0));
        assert_eq!(scores.accuracy, Some(0.6));
        let precision = (1.0 + 2.0 / 3.0 + 3.0 / 5.0) / 3.0;
        assert!((scores.average_precision.unwrap() - precision).abs() < 1e-12);
        let error = (0.1 + 0.8 + 0.3 + 0.2 + 0.9) / 5.0;
        assert!((scores.calibration_error.unwrap() - error).abs() < 1e-12);
        // All three, for two wrong ones: 6 / 8 is more than 2 / 3 and 4 / 5 does not occur.
        assert_eq!(best_threshold(&rows), 0.1);
    }

    #[test]
    fn scores_that_are_equal_stand_or_fall_together() {
        let rows = judged(&[(0.5, true), (0.5, false), (0.5, true), (0.1, false)]);
        assert_eq!(best_threshold(&rows), 0.5);
        assert!((average_precision(&rows).unwrap() - 2.0 / 3.0).abs() < 1e-12);
    }

    #[test]
    fn what_has_no_meaning_has_no_value() {
        assert_eq!(Scores::new(&[], 0.5), Scores::default());
        let artifacts = Scores::new(&judged(&[(0.1, false)]), 0.5);
        assert_eq!((artifacts.f1, artifacts.average_precision, artifacts.accuracy), (None, None, Some(1.0)));
        assert_eq!(Scores::mean(&[artifacts, Scores::default()]).accuracy, Some(1.0));
    }
}
