//! Which way evidence points, where physics leaves no doubt.

/// By name: 1 where more of it never speaks against a detection, -1 where it never speaks for it.
const DIRECTIONS: &[(&str, i8)] = &[("lidar_residual_horizontal", -1)];

/// The direction of a feature; 0 of one that may point either way.
pub(super) fn direction(feature: &str) -> i8 {
    DIRECTIONS.iter().find(|(name, _)| *name == feature).map_or(0, |(_, direction)| *direction)
}
