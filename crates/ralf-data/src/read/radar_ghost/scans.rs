//! When a scan of a table was.

use crate::error::DataError;
use std::ops::Range;
use std::path::Path;

/// Units that times may be in, as nanoseconds, with what a step from scan to scan can be in each. Sensors take 10 ms to
/// 1 s for a scan, so that no step fits two of them.
const UNITS: [(f64, Range<f64>); 4] =
    [(1e9, 0.0099..0.99), (1e6, 9.9..990.0), (1e3, 9.9e3..9.9e5), (1.0, 9.9e6..9.9e8)];
/// Times lie within 146 years of 0, so that the difference of two is a time as well.
const LATEST_NS: f64 = i64::MAX as f64 / 2.0;

/// The unit of times that nothing tells: seconds.
pub(super) const UNTOLD: f64 = UNITS[0].0;

/// The unit of a sensor's times, as nanoseconds: the one in which the usual step from one to the next is a scan's. A
/// single moment tells none.
pub(super) fn unit(
    file: &Path,
    table: &str,
    times: impl Iterator<Item = f64>,
) -> Result<Option<f64>, DataError> {
    let mut distinct: Vec<f64> = times.collect();
    distinct.sort_unstable_by(f64::total_cmp);
    distinct.dedup();
    let mut steps: Vec<f64> = distinct.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let Some(usual) = steps.get(steps.len() / 2) else { return Ok(None) };
    let found = UNITS.iter().find(|(_, steps)| steps.contains(usual)).map(|(unit, _)| *unit);
    found.map(Some).ok_or_else(|| {
        let expected = "times of 10 ms to 1 s from scan to scan, in s, ms, us or ns";
        let place = format!("{table}, timestamp");
        DataError::content(file, place, expected, format!("a step of {usual}"))
    })
}

/// Times of this unit as nanoseconds.
pub(super) fn nanoseconds(file: &Path, table: &str, times: &[f64], unit: f64) -> Result<Vec<i64>, DataError> {
    let time = |(row, value): (usize, &f64)| {
        let t_ns = value * unit;
        (t_ns.abs() < LATEST_NS).then(|| t_ns.round() as i64).ok_or_else(|| {
            let place = format!("{table}, timestamp, row {row}");
            DataError::content(file, place, "a time", value.to_string())
        })
    };
    times.iter().enumerate().map(time).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_step_from_scan_to_scan_tells_the_unit() {
        let file = Path::new("a.h5");
        let told = |times: &[f64]| unit(file, "lidar", times.iter().copied());
        for expected in [1.0, 1e3, 1e6, 1e9] {
            let times = [0.0, 0.0, 0.07, 0.01, 0.13].map(|t| t * 1e9 / expected);
            assert_eq!(told(&times).unwrap(), Some(expected));
            let found = nanoseconds(file, "lidar", &times, expected).unwrap();
            assert_eq!(found, [0, 0, 70_000_000, 10_000_000, 130_000_000]);
        }
        assert_eq!([told(&[3.0, 3.0]).unwrap(), told(&[]).unwrap()], [None; 2]);
        let error = told(&[0.0, 3.0]).unwrap_err().to_string();
        assert!(error.starts_with("a.h5: lidar, timestamp: expected times of 10 ms to 1 s"), "{error}");
        for never in [f64::NAN, 1e300] {
            let error = nanoseconds(file, "lidar", &[0.0, never], 1e9).unwrap_err().to_string();
            assert!(error.contains("row 1: expected a time, found"), "{error}");
        }
    }
}
