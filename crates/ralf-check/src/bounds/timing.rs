//! A sensor's times.

use crate::remedy::Remedy;
use crate::statistics::median;
use crate::verdict::{Question, Verdict};

/// Between two scans in a row, s: the median of any sensor of a vehicle.
const SPACING: std::ops::Range<f64> = 0.004..3.0;

pub(super) fn judge(name: &str, times: &[i64]) -> Vec<Verdict> {
    let doubts = [spacing(name, times), equal(name, times)];
    doubts.into_iter().flatten().collect()
}

fn spacing(name: &str, times: &[i64]) -> Option<Verdict> {
    let steps: Vec<f64> =
        times.windows(2).map(|pair| pair[1].saturating_sub(pair[0]) as f64 * 1e-9).collect();
    let usual = median(&steps).filter(|usual| steps.len() >= 3 && !SPACING.contains(usual))?;
    let evidence = format!("its scans come every {usual:.6} s");
    let remedy = Remedy::LookInto("timestamps look like another unit than ns");
    Some(Verdict::doubt(name, Question::Bounds, evidence, Some(remedy)))
}

/// Measurements that have the time of the one before: no sensor measures twice at once.
fn equal(name: &str, times: &[i64]) -> Option<Verdict> {
    let same: Vec<usize> = (1..times.len()).filter(|i| times[*i] == times[i - 1]).collect();
    let first = *same.first()?;
    let evidence = format!(
        "{} of its {} measurements have the time of the one before, first number {first} at {} ns",
        same.len(),
        times.len(),
        times[first]
    );
    let remedy = Remedy::LookInto("a measurement may be recorded twice or in parts, or its clock may stand");
    Some(Verdict::doubt(name, Question::Bounds, evidence, Some(remedy)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_times_are_counted_and_the_first_is_named() {
        let found = judge("radar", &[0, 50_000_000, 50_000_000, 100_000_000, 150_000_000, 150_000_000]);
        assert_eq!(found.len(), 1, "{found:?}");
        let expected =
            "2 of its 6 measurements have the time of the one before, first number 2 at 50000000 ns";
        assert_eq!(found[0].evidence, expected);
        assert_eq!(judge("radar", &[0, 50_000_000, 100_000_000, 150_000_000]), []);
    }
}
