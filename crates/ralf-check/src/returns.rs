//! What came back of a LiDAR's scan, of which a part is looked at.

use ralf::sensors::is_return;

/// So many of what came back, evenly. What didn't is left out first: it may be every second point, as in a driver's
/// second echoes, and then every so many points are nothing else.
pub(crate) fn some_returns(points: impl Iterator<Item = [f32; 3]>, count: usize) -> Vec<[f32; 3]> {
    let returns: Vec<[f32; 3]> = points.filter(is_return).collect();
    let step = returns.len().div_ceil(count).max(1);
    returns.into_iter().step_by(step).collect()
}
