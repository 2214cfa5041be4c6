//! How sensors are mounted and how the vehicle moved, as `tf2_msgs/TFMessage` and `nav_msgs/Odometry`.

use super::names::{Names, ODOM, VEHICLE};
use ralf::geometry::Transform;
use ralf::motion::EgoMotion;
use ralf::rig::Rig;
use ralf_ros::message::{Header, Odometry, Pose, TfMessage, TransformStamped, Twist};

/// Where the sensors are on the vehicle.
pub(super) fn mountings(t_ns: i64, rig: &Rig, names: &Names) -> TfMessage {
    let radars = rig.radars.iter().map(|radar| &radar.vehicle_from_radar);
    let lidars = rig.lidars.iter().map(|lidar| &lidar.vehicle_from_lidar);
    let cameras = rig.cameras.iter().map(|camera| &camera.vehicle_from_camera);
    let mountings = radars.chain(lidars).chain(cameras).zip(names.all());
    let transforms = mountings.map(|(mounting, name)| stamped(t_ns, VEHICLE, name, mounting)).collect();
    TfMessage { transforms }
}

/// The times at which the motion is known, ascending.
pub(super) fn times(motion: &EgoMotion) -> Vec<i64> {
    let poses = motion.poses().iter().map(|sample| sample.t_ns);
    let mut times: Vec<i64> = motion.odometry().iter().map(|sample| sample.t_ns).chain(poses).collect();
    times.sort_unstable();
    times.dedup();
    times
}

/// Where the vehicle is, and how fast.
pub(super) fn odometry(t_ns: i64, motion: &EgoMotion) -> Odometry {
    let (linear, angular) = motion.twist(t_ns);
    Odometry {
        header: header(t_ns, ODOM),
        child_frame_id: VEHICLE.to_owned(),
        pose: pose(&motion.odom_from_vehicle(t_ns)),
        twist: Twist { linear: linear.into(), angular: angular.into() },
        ..Odometry::default()
    }
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
