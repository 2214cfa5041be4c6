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
pub(super) fn odometry(sample: &PoseSample, motion: &EgoMotion) -> Odometry {
    let (linear, angular) = motion.twist(sample.t_ns);
    Odometry {
        header: header(sample.t_ns, ODOM),
        child_frame_id: VEHICLE.to_owned(),
        pose: pose(&sample.odom_from_vehicle),
        twist: Twist { linear: linear.into(), angular: angular.into() },
        ..Odometry::default()
    }
}

/// What the wheels measured.
pub(super) fn twist(sample: &OdometrySample) -> TwistStamped {
    let twist = Twist { linear: [sample.velocity, 0.0, 0.0], angular: [0.0, 0.0, sample.yaw_rate] };
    TwistStamped { header: header(sample.t_ns, VEHICLE), twist }
}

/// Where the vehicle is, for those who show frames.
pub(super) fn vehicle(t_ns: i64, motion: &EgoMotion) -> TfMessage {
    TfMessage { transforms: vec![stamped(t_ns, ODOM, VEHICLE, &motion.odom_from_vehicle(t_ns))] }
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
