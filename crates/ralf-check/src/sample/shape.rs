//! What the numbers of a point cloud look like, which a wrong data type gives away.

use crate::thinning::some;

/// Points of a scan whose numbers are looked at.
const SHAPE_POINTS: usize = 5000;

/// What the numbers of a point cloud look like.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct CloudShape {
    pub(crate) points: usize,
    /// Share of points that are finite and not the origin.
    pub(crate) returns: f64,
    /// Median distance, m.
    pub(crate) range: f64,
    /// Share of returns more than 45 degrees above or below the sensor.
    pub(crate) steep: f64,
    /// Share of coordinates that no LiDAR gives.
    pub(crate) absurd: f64,
}

/// Whether a coordinate is none that a sensor gives: beyond 1000 km, or closer to 0 than a micrometre without being it.
pub(crate) fn is_absurd(value: &f64) -> bool {
    value.abs() > 1e6 || (*value != 0.0 && value.abs() < 1e-6)
}

impl CloudShape {
    /// Of what came back of so many points.
    pub(super) fn of(returns: &[[f32; 3]], points: usize) -> Self {
        let looked: Vec<[f64; 3]> = some(returns, SHAPE_POINTS).map(|p| p.map(f64::from)).collect();
        let norm = |p: &[f64; 3]| p[0].hypot(p[1]).hypot(p[2]);
        let share = |count: usize, of: usize| if of == 0 { 0.0 } else { count as f64 / of as f64 };
        let ranges: Vec<f64> = looked.iter().map(norm).collect();
        let steep = |p: &&[f64; 3]| p[2].abs() > p[0].hypot(p[1]);
        Self {
            points,
            returns: share(returns.len(), points),
            range: crate::statistics::median(&ranges).unwrap_or(0.0),
            steep: share(looked.iter().filter(steep).count(), looked.len()),
            absurd: share(looked.iter().flatten().filter(|value| is_absurd(value)).count(), 3 * looked.len()),
        }
    }
}
