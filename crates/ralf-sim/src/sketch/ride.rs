//! How the vehicle really moves, and what its wheels and poses say of it.

use super::relief::Relief;
use super::way::Way;
use crate::random::Random;
use nalgebra::{Translation3, UnitQuaternion};
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform, Vector};
use std::f64::consts::TAU;

/// Half the step of the numerical derivative of a place, s.
const HALF_STEP: f64 = 1e-3;
/// Between what wheels say and between poses, ns.
const ODOMETRY_NS: i64 = 20_000_000;
const POSE_NS: i64 = 10_000_000;
/// Standard deviations of a single speed (m/s) and of a single turn rate (rad/s).
const SINGLE: [f64; 2] = [0.02, 0.0015];
/// How often errors of poses swing, Hz.
const SWINGS: [f64; 4] = [0.07, 0.19, 0.4, 0.9];

/// Something that swings about 0.
#[derive(Debug, Clone, Copy)]
struct Swing {
    size: f64,
    /// Hz.
    rate: f64,
    phase: f64,
}

impl Swing {
    fn new(size: f64, rate: f64, random: &mut Random) -> Self {
        Self { size, rate, phase: random.between(0.0, TAU) }
    }

    fn at(&self, seconds: f64) -> f64 {
        self.size * (TAU * self.rate * seconds + self.phase).sin()
    }
}

/// A drive along a way.
#[derive(Debug)]
pub(super) struct Ride {
    way: Way,
    /// Mean speed, m/s, and how it swings about it.
    speed: f64,
    gas: Swing,
    pitch: Swing,
    roll: Swing,
}

impl Ride {
    pub(super) fn new(way: Way, speed: f64, random: &mut Random) -> Self {
        let share = random.between(0.0, 0.15);
        let rate = random.between(0.08, 0.25);
        let gas = Swing::new(share * speed, rate, random);
        let [nod, lean] = [random.between(0.0, 0.005), random.between(0.0, 0.004)];
        Self { way, speed, gas, pitch: Swing::new(nod, 1.3, random), roll: Swing::new(lean, 1.1, random) }
    }

    fn speed(&self, seconds: f64) -> f64 {
        self.speed + self.gas.at(seconds)
    }

    /// Along the way, m: the integral of the speed.
    fn along(&self, seconds: f64) -> f64 {
        let Swing { size, rate, phase } = self.gas;
        let swung = size / (TAU * rate) * (phase.cos() - (TAU * rate * seconds + phase).cos());
        self.speed * seconds + swung
    }

    /// In the site's frame.
    pub(super) fn pose(&self, relief: &Relief, seconds: f64) -> Transform {
        let [x, y, heading] = self.way.at(self.along(seconds), 0.0);
        let [roll, pitch] = [self.roll.at(seconds), self.pitch.at(seconds)];
        let attitude = relief.attitude(x, y, heading) * UnitQuaternion::from_euler_angles(roll, pitch, 0.0);
        Transform::from_parts(Translation3::new(x, y, relief.height(x, y)), attitude)
    }

    /// Of a sensor of the vehicle, in the site's frame, m/s.
    pub(super) fn velocity(&self, relief: &Relief, mount: &Transform, seconds: f64) -> Vector {
        let place = |t: f64| (self.pose(relief, t) * mount).translation.vector;
        (place(seconds + HALF_STEP) - place(seconds - HALF_STEP)) / (2.0 * HALF_STEP)
    }

    /// Places in the way until so many seconds have passed: x and y, m.
    pub(super) fn places(&self, seconds: f64) -> impl Iterator<Item = [f64; 3]> {
        (0..(seconds * 10.0) as usize).map(|step| self.way.at(self.along(step as f64 * 0.1), 0.0))
    }

    /// What wheels and poses say, for so many seconds.
    pub(super) fn said(
        &self,
        relief: &Relief,
        start_ns: i64,
        seconds: f64,
        random: &mut Random,
    ) -> Option<EgoMotion> {
        let [scale, offset] = [1.0 + random.normal(0.005), random.normal(0.0008)];
        let times = |step: i64| (0..=(seconds * 1e9) as i64 / step).map(move |index| index * step);
        let wheels = times(ODOMETRY_NS).map(|since_ns| {
            let t = (since_ns + ODOMETRY_NS / 2) as f64 * 1e-9;
            let yaw_rate = self.way.curvature(self.along(t)) * self.speed(t);
            OdometrySample {
                t_ns: start_ns + since_ns,
                velocity: self.speed(t) * scale + random.normal(SINGLE[0]),
                yaw_rate: yaw_rate + offset + random.normal(SINGLE[1]),
            }
        });
        let wheels = wheels.collect();
        let mut swings = |sigma: f64| SWINGS.map(|rate| Swing::new(random.normal(sigma / 2.0), rate, random));
        let shifts = [0.012; 3].map(&mut swings);
        let turns = [0.04_f64.to_radians(); 3].map(&mut swings);
        let error = |swings: &[[Swing; 4]; 3], t: f64| {
            let sum = |axis: usize| swings[axis].iter().map(|swing| swing.at(t)).sum::<f64>();
            Vector::new(sum(0), sum(1), sum(2))
        };
        let start = self.pose(relief, 0.0);
        let poses = times(POSE_NS).map(|since_ns| {
            let t = since_ns as f64 * 1e-9;
            let off = Transform::from_parts(
                Translation3::from(error(&shifts, t)),
                UnitQuaternion::from_scaled_axis(error(&turns, t)),
            );
            PoseSample {
                t_ns: start_ns + since_ns,
                odom_from_vehicle: start.inv_mul(&self.pose(relief, t)) * off,
            }
        });
        EgoMotion::new(wheels, poses.collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;
    use crate::scenario::Leg;

    #[test]
    fn the_way_is_the_integral_of_the_speed_and_wheels_say_about_that() {
        let random = &mut Random::new(2, Purpose::Placement, 0, 0);
        let way = Way::new(&[Leg { length: 60.0, turn_deg: 30.0 }], 100.0);
        let relief = Relief::new([0.03, 0.0], &[], random);
        let ride = Ride::new(way, 9.0, random);
        for t in [0.0, 1.3, 4.0] {
            let slope = (ride.along(t + HALF_STEP) - ride.along(t - HALF_STEP)) / (2.0 * HALF_STEP);
            assert!((slope - ride.speed(t)).abs() < 1e-6);
            let sensor = ride.velocity(&relief, &Transform::identity(), t).norm();
            assert!((sensor - ride.speed(t)).abs() < 0.02 * sensor, "{sensor}");
        }
        assert!(ride.along(0.0).abs() < 1e-9);
        let said = ride.said(&relief, 0, 4.0, random).unwrap();
        let last = said.poses().last().unwrap();
        let off = ride.pose(&relief, 0.0).inverse() * ride.pose(&relief, last.t_ns as f64 * 1e-9);
        let off = off.translation.vector - last.odom_from_vehicle.translation.vector;
        assert!(off.norm() < 0.2, "{off}");
    }
}
