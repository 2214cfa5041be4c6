//! When a LiDAR's points were measured.

/// A point farther in time from its scan is of another clock or unit, s.
pub(crate) const LONGEST: f64 = 1.0;

/// How long after its scan a point was measured, s and negative before it. The error says what was expected.
pub(crate) fn seconds_after(point_ns: i64, scan_ns: i64) -> Result<f32, String> {
    let seconds = point_ns.saturating_sub(scan_ns) as f64 * 1e-9;
    if seconds.abs() <= LONGEST {
        return Ok(seconds as f32);
    }
    Err(format!("a time within {LONGEST} s of the scan's, {scan_ns} ns"))
}
