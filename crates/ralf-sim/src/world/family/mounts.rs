//! Where sensors sit on vehicles.

use super::ranges::{Mount, MountedLidar, mount};
use crate::world::lidar::{
    CORNER, FORWARD, HDL_32, HDL_64, OS0_128, OS1_64, PANDAR_40, Pattern, VLP_16, VLS_128,
};

/// One behind the grille or on the bumper, as in View-of-Delft.
pub(super) const ONE: &[Mount] = &[mount("radar_front", [3.6, 0.0, 0.5], 0.0)];
/// Long range, ahead and behind, as in aiMotive.
pub(super) const FRONT_REAR: &[Mount] =
    &[mount("radar_front", [3.7, 0.0, 0.45], 0.0), mount("radar_rear", [-0.95, 0.0, 0.6], 180.0)];
/// All sides, as in the paper.
pub(super) const SIDES: &[Mount] = &[
    mount("radar_front", [3.7, 0.0, 0.5], 0.0),
    mount("radar_left", [2.6, 0.9, 0.5], 90.0),
    mount("radar_right", [2.6, -0.9, 0.5], -90.0),
    mount("radar_rear", [-0.9, 0.0, 0.5], 180.0),
];
/// Corners, as for blind spots and crossing traffic.
pub(super) const CORNERS: &[Mount] = &[
    mount("radar_front_left", [3.4, 0.8, 0.6], 50.0),
    mount("radar_front_right", [3.4, -0.8, 0.6], -50.0),
    mount("radar_rear_left", [-0.7, 0.75, 0.6], 140.0),
    mount("radar_rear_right", [-0.7, -0.75, 0.6], -140.0),
];
/// As in nuScenes: ahead, sides turned forward, and corners behind.
pub(super) const FIVE: &[Mount] = &[
    mount("radar_front", [3.41, 0.0, 0.5], 0.0),
    mount("radar_front_left", [2.42, 0.8, 0.78], 90.0),
    mount("radar_front_right", [2.42, -0.8, 0.77], -90.0),
    mount("radar_back_left", [-0.56, 0.63, 0.53], 175.0),
    mount("radar_back_right", [-0.56, -0.62, 0.53], -176.0),
];
/// Corners, ahead and behind.
pub(super) const SIX: &[Mount] = &[
    mount("radar_front", [3.7, 0.0, 0.5], 0.0),
    mount("radar_front_left", [3.4, 0.8, 0.6], 60.0),
    mount("radar_front_right", [3.4, -0.8, 0.6], -60.0),
    mount("radar_rear_left", [-0.7, 0.75, 0.6], 130.0),
    mount("radar_rear_right", [-0.7, -0.75, 0.6], -130.0),
    mount("radar_rear", [-0.95, 0.0, 0.6], 180.0),
];
/// Two that look ahead past the corners.
pub(super) const TWO: &[Mount] = &[
    mount("radar_front_left", [3.5, 0.7, 0.55], 25.0),
    mount("radar_front_right", [3.5, -0.7, 0.55], -25.0),
];

const ROOF: [f64; 3] = [1.1, 0.0, 1.85];
const TALL_ROOF: [f64; 3] = [0.95, 0.0, 2.05];

/// All of a vehicle.
pub(super) type Lidars = &'static [MountedLidar];

const fn lidar(name: &'static str, place: [f64; 3], yaw_deg: f64, pattern: Pattern) -> MountedLidar {
    MountedLidar { mount: mount(name, place, yaw_deg), pattern }
}

pub(super) const ROOF_16: Lidars = &[lidar("lidar_top", ROOF, 0.0, VLP_16)];
pub(super) const ROOF_32: Lidars = &[lidar("lidar_top", ROOF, 90.0, HDL_32)];
pub(super) const ROOF_40: Lidars = &[lidar("lidar_top", TALL_ROOF, 0.0, PANDAR_40)];
pub(super) const ROOF_64: Lidars = &[lidar("lidar_top", ROOF, 0.0, HDL_64)];
pub(super) const ROOF_64_EVEN: Lidars = &[lidar("lidar_top", TALL_ROOF, 0.0, OS1_64)];
pub(super) const ROOF_128: Lidars = &[lidar("lidar_top", TALL_ROOF, 0.0, VLS_128)];
pub(super) const ROOF_128_WIDE: Lidars = &[lidar("lidar_top", ROOF, 180.0, OS0_128)];
pub(super) const AHEAD: Lidars = &[lidar("lidar_front", [2.1, 0.0, 1.5], 0.0, FORWARD)];
pub(super) const ROOF_AND_CORNERS: Lidars = &[
    lidar("lidar_top", ROOF, 0.0, VLP_16),
    lidar("lidar_left", [3.2, 0.9, 0.7], 60.0, CORNER),
    lidar("lidar_right", [3.2, -0.9, 0.7], -60.0, CORNER),
];
pub(super) const AROUND: Lidars = &[
    lidar("lidar_front", [3.7, 0.0, 0.65], 0.0, CORNER),
    lidar("lidar_left", [1.4, 0.95, 1.0], 90.0, CORNER),
    lidar("lidar_right", [1.4, -0.95, 1.0], -90.0, CORNER),
    lidar("lidar_rear", [-0.95, 0.0, 0.8], 180.0, CORNER),
];
