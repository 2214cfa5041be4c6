//! How good labels are (paper, appendix; docs/method.md, sections 9 and 13): counts, metrics of one scan, and of many.
//!
//! "Positive" is plausible. A class that the truth of a scan holds none of has no value there: its precision, recall,
//! F1 and IoU are `None` and leave the mean over the classes and the mean over the scans.

mod confusion;
mod evaluation;
mod rates;
mod score;
mod separation;

pub use confusion::Confusion;
pub use evaluation::{Evaluation, Metrics, Scores, SequenceScores};
pub use rates::Rates;
pub use score::{Ranked, RankedPoint, Reliability, ScoreWorth, ScoredDetections, average_precision};
pub use separation::Separation;
