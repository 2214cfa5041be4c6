//! Names of frames and topics: letters, digits and underscores, as ROS wants them.

pub(super) use crate::read::ros::LABELLED;
use ralf::sensors::Rig;
use std::borrow::Cow;

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
    format!("/{}{name}", part(sensor))
}

/// The topic of a camera's images.
pub(super) fn image(camera: &str) -> String {
    format!("/{}/image_raw/compressed", part(camera))
}

/// The topic of a camera's calibration.
pub(super) fn camera_info(camera: &str) -> String {
    format!("/{}/camera_info", part(camera))
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
        let mut frames: Vec<_> = names.all().chain([VEHICLE, ODOM]).map(Cow::from).collect();
        let mut topics: Vec<_> = names.all().map(part).collect();
        for (what, all) in [("frames", &mut frames), ("topics", &mut topics)] {
            all.sort_unstable();
            if let Some(pair) = all.windows(2).find(|pair| pair[0] == pair[1]) {
                return Err(format!("two {what} of the name `{}`", pair[0]));
            }
        }
        Ok(names)
    }

    /// Radars, LiDARs, cameras.
    pub(super) fn all(&self) -> impl Iterator<Item = &str> {
        self.radars.iter().chain(&self.lidars).chain(&self.cameras).map(String::as_str)
    }
}

/// A sensor's name as a part of topics, which in ROS 2 begin with no digit; frames may.
fn part(sensor: &str) -> Cow<'_, str> {
    if sensor.starts_with(|first: char| first.is_ascii_digit()) {
        return format!("n{sensor}").into();
    }
    sensor.into()
}

fn in_ros(name: &str) -> String {
    name.replace(|c: char| !c.is_ascii_alphanumeric(), "_")
}
