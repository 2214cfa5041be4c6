//! A part of many points, to look at.

use ralf::sensors::is_return;

/// At most so many of some values, and more than half as many, or all where they are fewer, evenly.
pub(crate) fn some<T>(values: &[T], count: usize) -> impl Iterator<Item = &T> {
    values.iter().step_by(values.len().div_ceil(count).max(1))
}

/// Exactly so many indices, evenly over a list from its first to its last, or all of a short one: of 13 images 12,
/// where [`some`] has 7.
pub(crate) fn spread(length: usize, count: usize) -> Vec<usize> {
    if length <= count {
        return (0..length).collect();
    }
    (0..count).map(|i| i * (length - 1) / (count - 1).max(1)).collect()
}

/// What came back of a LiDAR's scan. What didn't is left out before a part is looked at: it may be every second point,
/// as in a driver's second echoes, and then every so many points are nothing else.
pub(crate) fn returns(points: impl Iterator<Item = [f32; 3]>) -> Vec<[f32; 3]> {
    points.filter(is_return).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_are_spread_from_the_first_to_the_last() {
        assert_eq!(spread(3, 5), [0, 1, 2]);
        assert_eq!(spread(101, 5), [0, 25, 50, 75, 100]);
        assert!(spread(0, 5).is_empty());
    }
}
