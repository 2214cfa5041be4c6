//! A sensor's times.

use crate::remedy::Remedy;
use crate::statistics::median;
use crate::verdict::{Question, Verdict};

/// Between two scans in a row, s: the median of any sensor of a vehicle.
const SPACING: std::ops::Range<f64> = 0.004..3.0;

pub(super) fn judge(name: &str, times: &[i64]) -> Option<Verdict> {
    let steps: Vec<f64> = times.windows(2).map(|pair| (pair[1] - pair[0]) as f64 * 1e-9).collect();
    let usual = median(&steps).filter(|usual| steps.len() >= 3 && !SPACING.contains(usual))?;
    let evidence = format!("its scans come every {usual:.6} s");
    let remedy = Remedy::LookInto("timestamps look like another unit than ns");
    Some(Verdict::doubt(name, Question::Bounds, evidence, Some(remedy)))
}
