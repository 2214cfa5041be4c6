//! Which topic of a ROS recording is which sensor: the table `topics` of the settings.

use ralf::config::ConfigError;
use ralf::scene::Doppler;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// `topics`: by the sensor's name, which topic of a ROS recording it is. Other recordings need none.
pub type Topics = BTreeMap<String, TopicConfig>;

/// `topics.NAME`: a topic, and what it is. NAME becomes the sensor's.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TopicConfig {
    /// As the recording names it.
    pub topic: String,
    /// What it is.
    pub kind: TopicKind,
    /// Radar or LiDAR: whose uncertainties and field of view it has; `sensors.NAME` may replace them one by one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<String>,
    /// Radar: whether it measures elevation; as the model says, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub elevation: Option<bool>,
    /// Radar: the field that tells the raw range rate, m/s and positive when receding; `doppler`, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub doppler: Option<String>,
    /// Radar: whether range rates are derived from a velocity where no field tells them; `true`, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub derive_doppler: Option<bool>,
    /// Camera: the topic of its `sensor_msgs/CameraInfo`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub info: Option<String>,
    /// Camera: whether its images were rectified, so that the projection `P` holds for them, and no distortion.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rectified: Option<bool>,
    /// LiDAR: whether points that carry a time were moved to the header's time already; `false`, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion_corrected: Option<bool>,
    /// Sensor: its frame; that of the messages, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frame: Option<String>,
    /// The vehicle's frame, of whichever topic it is told; that of the motion's own messages, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub vehicle_frame: Option<String>,
    /// Where times come from; the header, if not given.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stamps: Option<Stamps>,
}

/// What a topic is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum TopicKind {
    /// `sensor_msgs/PointCloud2` or `radar_msgs/RadarScan`.
    Radar,
    /// `sensor_msgs/PointCloud2`.
    Lidar,
    /// `sensor_msgs/CompressedImage` or `sensor_msgs/Image`.
    Camera,
    /// `nav_msgs/Odometry`: poses, velocity and yaw rate.
    Odometry,
    /// `geometry_msgs/TwistStamped`, or of a `nav_msgs/Odometry` the twist alone: velocity and yaw rate.
    Twist,
    /// `sensor_msgs/Imu`: yaw rate, in place of that of the odometry.
    Imu,
    /// `tf2_msgs/TFMessage`: frames that move.
    Tf,
    /// `tf2_msgs/TFMessage`: frames that don't.
    TfStatic,
}

impl TopicKind {
    /// Whether it is a radar, a LiDAR or a camera.
    pub(super) fn is_sensor(self) -> bool {
        matches!(self, Self::Radar | Self::Lidar | Self::Camera)
    }
}

/// Where the time of a measurement comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Stamps {
    /// The message's header: when it was measured.
    Header,
    /// The recorder: when it arrived. For drivers that leave the header at 0.
    Log,
}

impl TopicConfig {
    /// A topic of this kind, all else as the messages have it.
    pub fn new(topic: &str, kind: TopicKind) -> Self {
        Self {
            topic: topic.to_owned(),
            kind,
            model: None,
            elevation: None,
            doppler: None,
            derive_doppler: None,
            info: None,
            rectified: None,
            motion_corrected: None,
            frame: None,
            vehicle_frame: None,
            stamps: None,
        }
    }

    /// The field of a radar's range rate, where it is called otherwise than here.
    pub(super) fn other_rate(&self) -> Option<&str> {
        self.doppler.as_deref().filter(|field| *field != Doppler::RAW)
    }

    /// Keys that are given and have no meaning for this kind.
    fn out_of_place(&self) -> Option<&'static str> {
        use TopicKind::{Camera, Imu, Lidar, Radar, Tf, TfStatic};
        let given = [
            ("model", self.model.is_some(), [Radar, Lidar].as_slice()),
            ("elevation", self.elevation.is_some(), &[Radar]),
            ("doppler", self.doppler.is_some(), &[Radar]),
            ("derive_doppler", self.derive_doppler.is_some(), &[Radar]),
            ("info", self.info.is_some(), &[Camera]),
            ("rectified", self.rectified.is_some(), &[Camera]),
            ("motion_corrected", self.motion_corrected.is_some(), &[Lidar]),
            ("frame", self.frame.is_some(), &[Radar, Lidar, Camera, Imu]),
        ];
        let stamps = ("stamps", self.stamps.is_some() && matches!(self.kind, Tf | TfStatic), [].as_slice());
        let all = given.into_iter().chain([stamps]);
        all.into_iter().find(|(_, given, kinds)| *given && !kinds.contains(&self.kind)).map(|(key, ..)| key)
    }
}

/// Refuses keys that have no meaning for their kind, and cameras and sensors that lack one.
pub(crate) fn check(topics: &Topics) -> Result<(), ConfigError> {
    for (name, topic) in topics {
        let refused = |key: &str, expected: String| {
            Err(ConfigError::Value { key: format!("topics.{name}.{key}"), expected })
        };
        if let Some(key) = topic.out_of_place() {
            return refused(key, format!("no such key for the kind {:?}", topic.kind));
        }
        let missing = match topic.kind {
            TopicKind::Radar | TopicKind::Lidar if topic.model.is_none() => "model",
            TopicKind::Camera if topic.info.is_none() => "info",
            _ => continue,
        };
        return refused(missing, "to be given".to_owned());
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use crate::settings::Settings;

    #[test]
    fn keys_are_checked_by_kind() {
        let error = |text: &str| Settings::from_toml(text, &[]).unwrap_err().to_string();
        let radar = "[topics.front]\ntopic = \"/front\"\nkind = \"radar\"\n";
        assert_eq!(error(radar), "setting `topics.front.model`: expected to be given");
        let info = format!("{radar}model = \"generic\"\ninfo = \"/info\"");
        assert!(
            error(&info).contains("topics.front.info`: expected no such key for the kind Radar"),
            "{}",
            error(&info)
        );
        assert!(
            error("[topics.tf]\ntopic = \"/tf\"\nkind = \"tf\"\nstamps = \"log\"")
                .contains("topics.tf.stamps")
        );
        assert!(error("[topics.tf]\ntopic = \"/tf\"\nkind = \"tree\"").contains("tf_static"));
        let config = Settings::from_toml(&format!("{radar}model = \"generic\""), &[]).unwrap();
        assert_eq!(Settings::from_toml(&config.to_toml().unwrap(), &[]), Ok(config));
    }
}
