//! What tuning strives for.

use ralf::metrics::{Confusion, Rates};
use std::fmt;
use std::str::FromStr;
use thiserror::Error;

/// A metric of the pooled counts; more is better.
///
/// ```
/// use ralf_train::Objective;
/// assert_eq!("f1".parse(), Ok(Objective::F1));
/// assert_eq!("recall@precision=0.8".parse(), Ok(Objective::RecallAtPrecision(0.8)));
/// assert!("recall@precision=1.5".parse::<Objective>().is_err());
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Objective {
    /// F1 of plausible detections.
    F1,
    /// Mean IoU of both classes.
    Iou,
    /// Share of detections labelled right.
    Accuracy,
    /// Recall of plausible detections, at a precision of at least this.
    RecallAtPrecision(f64),
}

/// No objective.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("expected f1, iou, accuracy, or recall@precision=P with P above 0 and at most 1, found `{0}`")]
pub struct ObjectiveError(String);

impl Objective {
    /// How good the counts are, in [0, 1]. Where precision is below the floor, it is the precision less 1: below every
    /// score that keeps the floor, and the nearer to it the better.
    pub fn score(&self, counts: &Confusion) -> f64 {
        let rates = Rates::new(counts);
        let score = match *self {
            Self::F1 => rates.f1_plausible,
            Self::Iou => rates.mean_iou,
            Self::Accuracy => rates.accuracy,
            Self::RecallAtPrecision(floor) => rates
                .precision_plausible
                .zip(rates.recall_plausible)
                .map(|(precision, recall)| if precision >= floor { recall } else { precision - 1.0 }),
        };
        // Without a truth of that class nothing can be said for the counts.
        score.unwrap_or(-1.0)
    }

    /// Whether a score is one of [`score`](Self::score) that keeps the floor of precision.
    pub fn is_met(&self, score: f64) -> bool {
        score >= 0.0
    }
}

impl FromStr for Objective {
    type Err = ObjectiveError;

    fn from_str(text: &str) -> Result<Self, ObjectiveError> {
        let refused = || ObjectiveError(text.to_owned());
        match text {
            "f1" => Ok(Self::F1),
            "iou" => Ok(Self::Iou),
            "accuracy" => Ok(Self::Accuracy),
            _ => {
                let floor = text.strip_prefix("recall@precision=").and_then(|floor| floor.parse().ok());
                let floor = floor.filter(|floor: &f64| *floor > 0.0 && *floor <= 1.0);
                floor.map(Self::RecallAtPrecision).ok_or_else(refused)
            }
        }
    }
}

impl fmt::Display for Objective {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::F1 => f.write_str("f1"),
            Self::Iou => f.write_str("iou"),
            Self::Accuracy => f.write_str("accuracy"),
            Self::RecallAtPrecision(floor) => write!(f, "recall@precision={floor}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back_and_all_else_refused() {
        for text in ["f1", "iou", "accuracy", "recall@precision=0.8", "recall@precision=1"] {
            assert_eq!(text.parse::<Objective>().unwrap().to_string(), text);
        }
        for text in ["", "F1", "recall", "recall@precision=", "recall@precision=0", "recall@precision=80%"] {
            let error = text.parse::<Objective>().unwrap_err().to_string();
            assert!(error.ends_with(&format!("found `{text}`")), "{error}");
        }
        assert!("recall@precision=nan".parse::<Objective>().is_err());
    }

    #[test]
    fn recall_counts_only_above_the_floor_of_precision() {
        let objective = Objective::RecallAtPrecision(0.75);
        let score = |tp, fp, missed| objective.score(&Confusion { tp, fp, tn: 9, r#fn: missed });
        assert_eq!(score(3, 1, 3), 0.5);
        assert_eq!(score(3, 2, 0), 0.6 - 1.0);
        assert_eq!(score(0, 0, 3), -1.0);
        assert!(objective.is_met(score(3, 1, 3)) && !objective.is_met(score(3, 2, 0)));
    }
}
