//! What may be wrong, as a change that would put it right.

use nalgebra::{Translation3, UnitQuaternion};
use ralf::space::{EgoMotion, OdometrySample, PoseSample};
use ralf::space::{Point, Transform, Vector};
use serde::Serialize;

/// A change of one sensor: its mounting, its clock, its handedness.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct SensorChange {
    /// Roll, pitch and yaw that are added, degrees, about the sensor's own axes x, y, z: yaw first, as in `R Rz Ry Rx`.
    pub turn_deg: [f64; 3],
    /// Added to the translation, m, vehicle frame.
    pub shift_m: [f64; 3],
    /// Added to the timestamps, ms.
    pub clock_ms: f64,
    /// Whether left and right are exchanged in the measurements.
    pub mirrored: bool,
}

impl SensorChange {
    /// A yaw and nothing else.
    pub(crate) fn yaw(degrees: f64) -> Self {
        Self { turn_deg: [0.0, 0.0, degrees], ..Self::default() }
    }

    /// A roll and a pitch and nothing else.
    pub(crate) fn tilt(roll: f64, pitch: f64) -> Self {
        Self { turn_deg: [roll, pitch, 0.0], ..Self::default() }
    }

    /// A shift in plan and nothing else.
    pub(crate) fn shift(x: f64, y: f64) -> Self {
        Self { shift_m: [x, y, 0.0], ..Self::default() }
    }

    /// A clock's offset and nothing else.
    pub(crate) fn clock(clock_ms: f64) -> Self {
        Self { clock_ms, ..Self::default() }
    }

    /// Left for right and nothing else.
    pub(crate) fn mirror() -> Self {
        Self { mirrored: true, ..Self::default() }
    }

    /// x for y and nothing else: left for right, and a quarter of a turn.
    pub(crate) fn exchange() -> Self {
        Self { mirrored: true, ..Self::yaw(90.0) }
    }

    /// Both changes.
    pub(crate) fn and(&self, other: &Self) -> Self {
        let sum = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
        Self {
            turn_deg: sum(self.turn_deg, other.turn_deg),
            shift_m: sum(self.shift_m, other.shift_m),
            clock_ms: self.clock_ms + other.clock_ms,
            mirrored: self.mirrored != other.mirrored,
        }
    }

    /// So many times the change.
    pub(crate) fn times(&self, factor: f64) -> Self {
        Self {
            turn_deg: self.turn_deg.map(|value| value * factor),
            shift_m: self.shift_m.map(|value| value * factor),
            clock_ms: self.clock_ms * factor,
            mirrored: self.mirrored,
        }
    }

    /// How much of this unit another change holds.
    pub(crate) fn value_in(&self, change: &Self) -> f64 {
        let product = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        product(self.turn_deg, change.turn_deg)
            + product(self.shift_m, change.shift_m)
            + self.clock_ms * change.clock_ms
    }

    /// The mounting with the change.
    pub(crate) fn mount(&self, recorded: &Transform) -> Transform {
        let [roll, pitch, yaw] = self.turn_deg.map(f64::to_radians);
        let turn = UnitQuaternion::from_euler_angles(roll, pitch, yaw);
        let place = recorded.translation.vector + Vector::from(self.shift_m);
        Transform::from_parts(Translation3::from(place), recorded.rotation * turn)
    }

    /// A time with the change, ns.
    pub(crate) fn time(&self, t_ns: i64) -> i64 {
        t_ns.saturating_add((self.clock_ms * 1e6) as i64)
    }

    /// A measured place with the change, sensor frame.
    pub(crate) fn place(&self, p: &Point) -> Point {
        if self.mirrored { Point::new(p.x, -p.y, p.z) } else { *p }
    }
}

/// A change of what is recorded of the vehicle's motion.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct MotionChange {
    /// Factor of the speed (of poses: of their translations).
    pub speed: f64,
    /// Factor of the yaw rate (of poses: of their yaw, -1 only).
    pub yaw_rate: f64,
    /// Added to the timestamps, ms.
    pub clock_ms: f64,
}

impl Default for MotionChange {
    fn default() -> Self {
        Self { speed: 1.0, yaw_rate: 1.0, clock_ms: 0.0 }
    }
}

impl MotionChange {
    /// Another unit or sign of the speed.
    pub(crate) fn speed(speed: f64) -> Self {
        Self { speed, ..Self::default() }
    }

    /// Another unit or sign of the yaw rate.
    pub(crate) fn yaw_rate(yaw_rate: f64) -> Self {
        Self { yaw_rate, ..Self::default() }
    }

    /// The motion with the change.
    pub(crate) fn of(&self, motion: &EgoMotion) -> EgoMotion {
        let shift = (self.clock_ms * 1e6) as i64;
        let odometry = motion.odometry().iter().map(|sample| OdometrySample {
            t_ns: sample.t_ns.saturating_add(shift),
            velocity: sample.velocity * self.speed,
            yaw_rate: sample.yaw_rate * self.yaw_rate,
        });
        let poses = motion.poses().iter().map(|pose| PoseSample {
            t_ns: pose.t_ns.saturating_add(shift),
            odom_from_vehicle: self.pose(&pose.odom_from_vehicle),
        });
        EgoMotion::new(odometry.collect(), poses.collect()).unwrap_or_else(|| motion.clone())
    }

    fn pose(&self, pose: &Transform) -> Transform {
        let mut rotation = pose.rotation;
        if self.yaw_rate < 0.0 {
            let (roll, pitch, yaw) = rotation.euler_angles();
            rotation = UnitQuaternion::from_euler_angles(roll, pitch, -yaw);
        }
        Transform::from_parts(Translation3::from(pose.translation.vector * self.speed), rotation)
    }
}

/// The motion that places rest on: 6-DoF poses where there are some, else wheel odometry. Odometry beside poses, which
/// speeds rest on, is judged for itself.
pub(crate) fn used_motion(motion: &EgoMotion) -> EgoMotion {
    let poses = EgoMotion::new(vec![], motion.poses().to_vec());
    poses.unwrap_or_else(|| motion.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_yaw_turns_the_sensor_about_its_own_place() {
        let mount = Transform::translation(3.0, 0.0, 0.5);
        let changed = SensorChange::yaw(90.0).mount(&mount);
        assert!((changed * Point::new(2.0, 0.0, 0.0) - Point::new(3.0, 2.0, 0.5)).norm() < 1e-12);
        let shifted = SensorChange::shift(0.5, -1.0).mount(&mount);
        assert_eq!(shifted.translation.vector, Vector::new(3.5, -1.0, 0.5));
    }

    #[test]
    fn what_x_and_y_were_exchanged_of_comes_back() {
        let change = SensorChange::exchange();
        let place = change.mount(&Transform::identity()) * change.place(&Point::new(3.0, 8.0, 0.5));
        assert!((place - Point::new(8.0, 3.0, 0.5)).norm() < 1e-12);
    }

    #[test]
    fn a_motion_in_kilometres_per_hour_is_put_right() {
        let told = vec![OdometrySample { t_ns: 0, velocity: 36.0, yaw_rate: 0.1 }];
        let right = MotionChange::speed(1.0 / 3.6).of(&EgoMotion::new(told, vec![]).unwrap());
        assert!((right.twist(0).0.x - 10.0).abs() < 1e-12 && right.twist(0).1.z == 0.1);
    }
}
