//! A part of many points, to look at.

use ralf::sensors::is_return;

/// At most so many of some values, and more than half as many, or all where they are fewer, evenly.
pub(crate) fn some<T>(values: &[T], count: usize) -> impl Iterator<Item = &T> {
    values.iter().step_by(values.len().div_ceil(count).max(1))
}

/// The places of exactly so many of a list's values, or of all where they are fewer, evenly: of 13 images 12, where
/// [`some`] has 7.
pub(crate) fn evenly(length: usize, count: usize) -> impl Iterator<Item = usize> {
    let count = count.min(length);
    (0..count).map(move |i| i * length / count)
}

/// What came back of a LiDAR's scan. What didn't is left out before a part is looked at: it may be every second point,
/// as in a driver's second echoes, and then every so many points are nothing else.
pub(crate) fn returns(points: impl Iterator<Item = [f32; 3]>) -> Vec<[f32; 3]> {
    points.filter(is_return).collect()
}
