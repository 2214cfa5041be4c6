//! Floor detections: a detection on the road is implausible (docs/method.md, section 4).

use super::ground::Ground;
use super::lidar::LidarView;
use super::located::Detection;
use crate::config::{GroundConfig, GroundModel};
use crate::sensors::{Elevation, Radar};
use crate::space::{Point, Transform};

/// The ground, in a vehicle frame at another time than its own.
#[derive(Debug, Clone)]
pub struct LocalGround {
    ground: Ground,
    /// From the vehicle frame at hand to the ground's own.
    ground_from_vehicle: Transform,
}

impl LocalGround {
    /// The ground around a radar scan or an image, in the vehicle frame that its view of the LiDAR leads to. `None`
    /// where there is none; the flat one is there without any LiDAR.
    pub fn around(lidar: Option<&LidarView>, config: &GroundConfig) -> Option<Self> {
        if config.model == GroundModel::Flat {
            return Some(Self { ground: Ground::flat(), ground_from_vehicle: Transform::identity() });
        }
        let view = lidar?;
        let ground = view.moment.ground()?.clone();
        Some(Self { ground, ground_from_vehicle: view.vehicle_from_moment.inverse() })
    }

    /// Height of a point above the ground, m.
    pub fn height(&self, p: &Point) -> f64 {
        self.ground.height(&(self.ground_from_vehicle * p))
    }

    /// Whether a radar's detection lies on the floor: `height + k sqrt(n^T Sigma_i n) < ground.radar_clearance` with
    /// `k = ground.radar_sigmas`; `k = 0` is the paper's rule. A radar without elevation makes no floor detections.
    pub fn is_floor_detection(&self, radar: &Radar, detection: &Detection, config: &GroundConfig) -> bool {
        if radar.elevation == Elevation::None {
            return false;
        }
        let moved = detection.moved(&self.ground_from_vehicle);
        let plane = self.ground.plane_at(&moved.position);
        let slack = config.radar_sigmas * moved.sigma_along(&plane.normal);
        plane.height(&moved.position) + slack < config.radar_clearance
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::Reliability;
    use nalgebra::{Matrix3, Vector3};

    fn radar(elevation: Elevation) -> Radar {
        Radar {
            name: "front".into(),
            fields: vec![],
            vehicle_from_radar: Transform::identity(),
            elevation,
            fov_azimuth: 2.0,
            fov_elevation: 0.3,
            sigma_range: 0.1,
            sigma_azimuth: 0.01,
            sigma_elevation: 0.02,
            reliability: Reliability::default(),
        }
    }

    #[test]
    fn an_uncertain_height_is_no_floor_detection() {
        let ground = LocalGround { ground: Ground::flat(), ground_from_vehicle: Transform::identity() };
        let at = |z: f64| Detection {
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
            let found = ground.is_floor_detection(&radar(Elevation::Measured), &at(z), &config(sigmas));
            assert_eq!(found, expected, "z {z}, {sigmas} sigmas");
            assert!(!ground.is_floor_detection(&radar(Elevation::None), &at(z), &config(sigmas)));
        }
    }
}
