//! Floor detections: a detection on the road is implausible (METHOD 4.3).

use super::LidarView;
use super::ground::Ground;
use crate::config::{GroundConfig, GroundModel};
use crate::detections::Located;
use crate::geometry::Transform;
use crate::rig::{Elevation, Radar};

/// The ground below a radar scan.
#[derive(Debug, Clone)]
pub struct Floor {
    ground: Ground,
    /// From the vehicle frame at the radar scan's time to the ground's own.
    ground_from_vehicle: Transform,
}

impl Floor {
    /// The ground below a radar's scan; `None` for a radar without elevation, which makes no floor detections, and where
    /// there is no ground. The flat one is there without any LiDAR.
    pub(crate) fn below(radar: &Radar, lidar: Option<&LidarView>, config: &GroundConfig) -> Option<Self> {
        if radar.elevation == Elevation::None {
            return None;
        }
        if config.model == GroundModel::Flat {
            return Some(Self { ground: Ground::flat(), ground_from_vehicle: Transform::identity() });
        }
        let view = lidar?;
        let ground = view.moment.ground()?.clone();
        Some(Self { ground, ground_from_vehicle: view.vehicle_from_moment.inverse() })
    }

    /// Whether a detection (vehicle frame) lies on the floor: `height + k sqrt(n^T Sigma_i n) < ground.radar_clearance`
    /// with `k = ground.radar_sigmas`; `k = 0` is the paper's rule.
    pub fn holds(&self, detection: &Located, config: &GroundConfig) -> bool {
        let moved = detection.moved(&self.ground_from_vehicle);
        let plane = self.ground.plane_at(&moved.position);
        let slack = config.radar_sigmas * moved.sigma_along(&plane.normal);
        plane.height(&moved.position) + slack < config.radar_clearance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Point;
    use nalgebra::{Matrix3, Vector3};

    #[test]
    fn an_uncertain_height_is_no_floor_detection() {
        let floor = Floor { ground: Ground::flat(), ground_from_vehicle: Transform::identity() };
        let at = |z: f64| Located {
            position: Point::new(10.0, 0.0, z),
            axes: Matrix3::from_diagonal(&Vector3::new(0.1, 0.1, 0.2)),
        };
        let config = |radar_sigmas| GroundConfig { radar_sigmas, ..GroundConfig::default() };
        // The clearance is 0.10 m, the detection's height is uncertain by 0.20 m.
        for (z, sigmas, expected) in [
            (0.09, 0.0, true),
            (0.10, 0.0, false),
            (-0.29, 2.0, false),
            (-0.31, 2.0, true),
            (-0.5, 0.0, true),
        ] {
            assert_eq!(floor.holds(&at(z), &config(sigmas)), expected, "z {z}, {sigmas} sigmas");
        }
    }
}
