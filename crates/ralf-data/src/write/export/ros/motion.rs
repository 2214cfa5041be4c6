//! How sensors are mounted and how the vehicle moved, as `tf2_msgs/TFMessage`, `nav_msgs/Odometry` and
//! `geometry_msgs/TwistStamped`.

use super::names::{Names, ODOM, VEHICLE};
use ralf::sensors::Rig;
use ralf::space::{EgoMotion, OdometrySample, PoseSample, Transform};
use ralf_ros::message::{Header, Odometry, Pose, TfMessage, TransformStamped, Twist, TwistStamped};

/// Where the sensors are on the vehicle.
pub(super) fn mountings(t_ns: i64, rig: &Rig, names: &Names) -> TfMessage {
    let radars = rig.radars.iter().map(|radar| &radar.vehicle_from_radar);
    let lidars = rig.lidars.iter().map(|lidar| &lidar.vehicle_from_lidar);
    let cameras = rig.cameras.iter().map(|camera| &camera.vehicle_from_camera);
    let mountings = radars.chain(lidars).chain(cameras).zip(names.all());
    let transforms = mountings.map(|(mounting, name)| stamped(t_ns, VEHICLE, name, mounting)).collect();
    TfMessage { transforms }
}

/// A pose as it was recorded, with the velocities that go with it.
pub(super) fn odometry(stamp_ns: i64, sample: &PoseSample, motion: &EgoMotion) -> Odometry {
    let (linear, angular) = motion.twist(sample.t_ns);
    Odometry {
        header: header(stamp_ns, ODOM),
        child_frame_id: VEHICLE.to_owned(),
        pose: pose(&sample.odom_from_vehicle),
        twist: Twist { linear: linear.into(), angular: angular.into() },
        ..Odometry::default()
    }
}

/// What the wheels measured.
pub(super) fn twist(stamp_ns: i64, sample: &OdometrySample) -> TwistStamped {
    let twist = Twist { linear: [sample.velocity, 0.0, 0.0], angular: [0.0, 0.0, sample.yaw_rate] };
    TwistStamped { header: header(stamp_ns, VEHICLE), twist }
}

/// Where the vehicle is, for those who show frames.
pub(super) fn vehicle(stamp_ns: i64, odom_from_vehicle: &Transform) -> TfMessage {
    TfMessage { transforms: vec![stamped(stamp_ns, ODOM, VEHICLE, odom_from_vehicle)] }
}

/// How much later than they were measured a recording's data are written, ns: ROS knows no time before 1970, and clocks
/// that count from the begin of a recording have some. Whole seconds, so that times are still known by their digits; 0
/// where there is no such time, or where the last one would be none any more.
pub(super) fn delay(first_ns: i64, last_ns: i64) -> i64 {
    const SECOND_NS: u64 = 1_000_000_000;
    let before = if first_ns < 0 { first_ns.unsigned_abs() } else { 0 };
    let delay = i64::try_from(before.div_ceil(SECOND_NS) * SECOND_NS).unwrap_or(0);
    if last_ns.checked_add(delay).is_some() { delay } else { 0 }
}

/// A header without a running number.
pub(super) fn header(stamp_ns: i64, frame: &str) -> Header {
    Header { seq: 0, stamp_ns, frame_id: frame.to_owned() }
}

fn stamped(t_ns: i64, parent: &str, child: &str, parent_from_child: &Transform) -> TransformStamped {
    TransformStamped {
        header: header(t_ns, parent),
        child_frame_id: child.to_owned(),
        transform: pose(parent_from_child),
    }
}

fn pose(transform: &Transform) -> Pose {
    Pose { position: transform.translation.vector.into(), orientation: transform.rotation.coords.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_before_1970_are_put_off_by_whole_seconds() {
        for (first, last, expected) in [
            (0, 5, 0),
            (1_700_000_000_000_000_000, 1_700_000_000_000_000_001, 0),
            (-1, 5, 1_000_000_000),
            (-1_000_000_000, 5, 1_000_000_000),
            (-1_000_000_001, 5, 2_000_000_000),
            (-1, i64::MAX, 0),
            (i64::MIN, i64::MIN, 0),
        ] {
            assert_eq!(delay(first, last), expected, "{first} to {last}");
        }
    }
}
