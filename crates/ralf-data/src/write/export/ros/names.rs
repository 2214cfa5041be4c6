//! Names of frames and topics: letters, digits and underscores, as ROS wants them.

pub(super) use crate::read::ros::LABELLED;
use ralf::sensors::Rig;

/// The vehicle's frame.
pub(super) const VEHICLE: &str = "base_link";
/// The frame that the vehicle moves in.
pub(super) const ODOM: &str = "odom";

/// What follows a radar's or a LiDAR's name in the topic of its clouds.
pub(super) const POINTS: &str = "/points";
/// Poses.
pub(super) const ODOMETRY: &str = "/odom";
/// What the wheels measured.
pub(super) const TWIST: &str = "/twist";
/// Where the vehicle is.
pub(super) const TF: &str = "/tf";
/// Where the sensors are on it.
pub(super) const TF_STATIC: &str = "/tf_static";

/// The topic of a sensor's clouds.
pub(super) fn cloud(sensor: &str, name: &str) -> String {
    format!("/{sensor}{name}")
}

/// The topic of a camera's images.
pub(super) fn image(camera: &str) -> String {
    format!("/{camera}/image_raw/compressed")
}

/// The topic of a camera's calibration.
pub(super) fn camera_info(camera: &str) -> String {
    format!("/{camera}/camera_info")
}

/// The names of a rig's sensors in ROS, each kind in the rig's order.
pub(super) struct Names {
    pub(super) radars: Vec<String>,
    pub(super) lidars: Vec<String>,
    pub(super) cameras: Vec<String>,
}

impl Names {
    /// The names; the error tells which two sensors would have the same.
    pub(super) fn of(rig: &Rig) -> Result<Self, String> {
        let names = Self {
            radars: rig.radars.iter().map(|radar| in_ros(&radar.name)).collect(),
            lidars: rig.lidars.iter().map(|lidar| in_ros(&lidar.name)).collect(),
            cameras: rig.cameras.iter().map(|camera| in_ros(&camera.name)).collect(),
        };
        let mut all: Vec<&str> = names.all().collect();
        all.extend([VEHICLE, ODOM]);
        all.sort_unstable();
        match all.windows(2).find(|pair| pair[0] == pair[1]) {
            Some(pair) => Err(format!("two frames of the name `{}`", pair[0])),
            None => Ok(names),
        }
    }

    /// Radars, LiDARs, cameras.
    pub(super) fn all(&self) -> impl Iterator<Item = &str> {
        self.radars.iter().chain(&self.lidars).chain(&self.cameras).map(String::as_str)
    }
}

fn in_ros(name: &str) -> String {
    name.replace(|c: char| !c.is_ascii_alphanumeric(), "_")
}
