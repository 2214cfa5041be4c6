//! Times as files tell them: of measurements, and of a LiDAR's points.

use ralf::sensors::LONGEST_AFTER;

/// Times lie within 146 years of 0, so that the difference of two is a time as well.
const LATEST_US: u64 = i64::MAX as u64 / 2000;

/// A time in us as ns; `None` of one that nothing can have.
pub(crate) fn nanoseconds(t_us: i64) -> Option<i64> {
    (t_us.unsigned_abs() <= LATEST_US).then(|| t_us * 1000)
}

/// How long after its scan a point was measured, s and negative before it. The error says what was expected.
pub(crate) fn seconds_after(point_ns: i64, scan_ns: i64) -> Result<f32, String> {
    let seconds = point_ns.saturating_sub(scan_ns) as f64 * 1e-9;
    if seconds.abs() <= LONGEST_AFTER {
        return Ok(seconds as f32);
    }
    Err(format!("a time within {LONGEST_AFTER} s of the scan's, {scan_ns} ns"))
}

#[cfg(test)]
mod tests {
    use super::nanoseconds;

    #[test]
    fn times_that_nothing_can_have_are_none() {
        assert_eq!(nanoseconds(-1_500_000), Some(-1_500_000_000));
        assert_eq!(nanoseconds(i64::MAX / 2000), Some(i64::MAX / 2000 * 1000));
        for t_us in [i64::MAX / 2000 + 1, i64::MAX, i64::MIN + 1, i64::MIN] {
            assert_eq!(nanoseconds(t_us), None, "{t_us}");
        }
    }
}
