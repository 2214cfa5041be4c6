//! Which way evidence points, where physics leaves no doubt.

/// More of these never speaks against a detection.
const FOR: &[&str] = &[
    "lidar_rays_in",
    "lidar_moving_in",
    "lidar_moving_near",
    "lidar_window_in",
    "lidar_window_odds",
    "lidar_window_near",
    "lidar_surface",
    "amplitude_over_floor",
    "persistence_excess",
    "camera_on",
];

/// More of these never speaks for it.
const AGAINST: &[&str] = &[
    "lidar_distance",
    "lidar_residual_horizontal",
    "lidar_rays_beyond",
    "lidar_chi",
    "lidar_moving_beyond",
    "lidar_moving_chi",
    "lidar_window_beyond",
    "lidar_window_chi_least",
    "lidar_window_chi_quartile",
    "lidar_window_chi_median",
    "lidar_free",
    "map_distance",
    "map_chi",
    "map_column_distance",
    "map_column_sigmas",
    "map_joint_distance",
    "map_joint_chi",
    "map_joint_column_distance",
    "map_joint_column_sigmas",
    "sight_behind_surface",
    "sight_behind_first_tall",
    "sight_behind_last_tall",
    "sight_through",
    "camera_least",
    "camera_through",
    "persistence_distance",
    "doppler_track_residual",
];

/// The direction of a feature: 1 where more of it never speaks against a detection, -1 where it never speaks for it, 0
/// where it may point either way.
pub fn direction(feature: &str) -> i8 {
    if FOR.contains(&feature) {
        1
    } else if AGAINST.contains(&feature) {
        -1
    } else {
        0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf::evidence::features;

    #[test]
    fn every_name_is_a_feature_and_points_one_way() {
        for name in FOR.iter().chain(AGAINST) {
            assert!(features().any(|feature| feature.name == *name), "{name}");
            assert!(!(FOR.contains(name) && AGAINST.contains(name)), "{name}");
        }
    }
}
