//! What a recording says of its sensors and its motion, where that isn't quite true.

use super::family::CalibrationRanges;
use super::lidar::LidarModel;
use super::radar::RadarModel;
use crate::mounting::off;
use crate::path::Path;
use crate::random::{Purpose, Random};
use nalgebra::{Translation3, UnitQuaternion};
use ralf::sensors::{Elevation, Lidar, Radar, Reliability, Rig};
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform, Vector};

/// Standard deviations are stated for what most detections have, some 16 dB: so much more than at 20 dB.
const USUAL_ERROR: f64 = 1.6;
/// Between samples of odometry and between poses, ns.
const ODOMETRY_NS: i64 = 20_000_000;
const POSE_NS: i64 = 50_000_000;
/// Standard deviation of a single speed, m/s.
const SPEED_SIGMA: f64 = 0.01;
/// Standard deviations of the gyro's offset and of a single turn rate, rad/s.
const YAW_RATE_SIGMAS: (f64, f64) = (0.0015, 0.003);
/// A LiDAR points are said to be at least so exact, m.
const LEAST_LIDAR_SIGMA: f64 = 0.02;

/// Errors of a recording, and the rig as it says it is.
#[derive(Debug, Clone)]
pub(super) struct Calibration {
    pub(super) rig: Rig,
    wheels: f64,
    poses: bool,
    drift: f64,
}

impl Calibration {
    pub(super) fn new(
        ranges: &CalibrationRanges,
        radars: &[RadarModel],
        lidars: &[LidarModel],
        seed: u64,
    ) -> Self {
        let mut random = Random::new(seed, Purpose::Calibration, 0, 0);
        let random = &mut random;
        let [angle, place] = [ranges.angle.draw(random), ranges.place.draw(random)];
        let radars = radars
            .iter()
            .map(|radar| {
                let said = off(&radar.vehicle_from_radar, angle, place, random);
                declared_radar(radar, said, 1.0 + ranges.sigmas.draw(random))
            })
            .collect();
        // All others are calibrated against the LiDAR: its own error is half as large.
        let lidars = lidars
            .iter()
            .map(|lidar| {
                declared_lidar(lidar, off(&lidar.vehicle_from_lidar, angle / 2.0, place / 2.0, random))
            })
            .collect();
        Self {
            rig: Rig { radars, lidars, cameras: Vec::new() },
            wheels: 1.0 + ranges.wheels.draw(random),
            poses: random.chance(ranges.poses),
            drift: ranges.drift.draw(random),
        }
    }

    /// What wheels and, if there are any, poses say of a drive of so many seconds.
    pub(super) fn motion(
        &self,
        path: &Path,
        true_pose: &dyn Fn(f64) -> Transform,
        start_ns: i64,
        seconds: f64,
        seed: u64,
    ) -> Option<EgoMotion> {
        let mut random = Random::new(seed, Purpose::Odometry, 0, 0);
        let offset = random.normal(YAW_RATE_SIGMAS.0);
        let count = (seconds * 1e9 / ODOMETRY_NS as f64).ceil() as i64 + 1;
        let mut samples = Vec::new();
        for i in 0..count {
            let state = path.state((i * ODOMETRY_NS + ODOMETRY_NS / 2) as f64 * 1e-9);
            samples.push(OdometrySample {
                t_ns: start_ns + i * ODOMETRY_NS,
                velocity: state.speed * self.wheels + random.normal(SPEED_SIGMA),
                yaw_rate: state.yaw_rate + offset + random.normal(YAW_RATE_SIGMAS.1),
            });
        }
        let poses =
            if self.poses { self.drifting(true_pose, start_ns, seconds, &mut random) } else { Vec::new() };
        EgoMotion::new(samples, poses)
    }

    /// Poses whose error grows with the way.
    fn drifting(
        &self,
        true_pose: &dyn Fn(f64) -> Transform,
        start_ns: i64,
        seconds: f64,
        random: &mut Random,
    ) -> Vec<PoseSample> {
        let start = true_pose(0.0);
        let count = (seconds * 1e9 / POSE_NS as f64).ceil() as i64 + 1;
        let mut pose = Transform::identity();
        let mut before = start;
        let mut found = Vec::new();
        let [scale, bend] = [1.0 + random.normal(self.drift), random.normal(self.drift) * 0.02];
        for i in 0..count {
            let now = true_pose((i * POSE_NS) as f64 * 1e-9);
            let step = before.inv_mul(&now);
            let way = step.translation.vector * scale;
            let turn = UnitQuaternion::from_axis_angle(&Vector::z_axis(), bend * way.norm());
            pose *= Transform::from_parts(Translation3::from(way), step.rotation * turn);
            found.push(PoseSample { t_ns: start_ns + i * POSE_NS, odom_from_vehicle: pose });
            before = now;
        }
        found
    }
}

fn declared_radar(radar: &RadarModel, said: Transform, factor: f64) -> Radar {
    let sigma = |cell: f64| cell * radar.accuracy * USUAL_ERROR * factor;
    let columns =
        ["x", "y", "z", "doppler"].into_iter().chain(radar.amplitudes.iter().map(|kind| kind.name()));
    Radar {
        name: radar.name.clone(),
        fields: columns.map(str::to_owned).collect(),
        vehicle_from_radar: said,
        elevation: if radar.elevation { Elevation::Measured } else { Elevation::None },
        fov_azimuth: radar.fov[0],
        fov_elevation: radar.fov[1],
        sigma_range: sigma(radar.cell.range),
        sigma_azimuth: sigma(radar.cell.azimuth),
        sigma_elevation: sigma(radar.cell.elevation),
        reliability: Reliability::default(),
    }
}

fn declared_lidar(lidar: &LidarModel, said: Transform) -> Lidar {
    Lidar {
        name: lidar.name.clone(),
        vehicle_from_lidar: said,
        sigma_range: lidar.optics.sigma.max(LEAST_LIDAR_SIGMA),
        lowest_beam: lidar.pattern.lowest(),
        max_range: Some(lidar.pattern.max_range),
    }
}

#[cfg(test)]
mod tests {
    use super::USUAL_ERROR;
    use crate::world::draw::World;
    use crate::world::family::FAMILIES;

    #[test]
    fn what_is_said_of_mountings_is_wrong_by_what_the_family_says_at_most() {
        for (family, seed) in FAMILIES.iter().zip(0..) {
            let world = World::new(family.into(), seed);
            let [angle, place] = [family.calibration.angle.high, family.calibration.place.high];
            let pairs = world.radars.iter().zip(&world.calibration.rig.radars);
            for (real, said) in pairs {
                let error = real.vehicle_from_radar.inv_mul(&said.vehicle_from_radar);
                let turned = error.rotation.angle().to_degrees();
                assert!(turned > 0.0 && turned < angle * 3.0_f64.sqrt() * 1.01, "{turned}");
                assert!(error.translation.vector.amax() > 0.0);
                assert!(error.translation.vector.norm() < place * 3.0_f64.sqrt() + 1e-9);
                assert!(real.clock_ns.abs() <= 20_000_000);
                let sigmas = said.sigma_range / (USUAL_ERROR * real.accuracy * real.cell.range);
                assert!((0.8..=1.3).contains(&sigmas), "{sigmas}");
            }
        }
    }
}
