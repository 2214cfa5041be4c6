//! The JSON files as they lie on disk. Keys that aren't needed are skipped.

use crate::read::rotation::Matrix;
use serde::de::Error;
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;

/// `sensor/calibration/calibration.json`: by the sensor's name.
pub(super) type Calibration = BTreeMap<String, Sensor>;

/// A sensor in it. What it needs depends on its type.
#[derive(Debug, Deserialize)]
pub(super) struct Sensor {
    /// `radar`, `lidar`, `camera`, `imu_ins`, `gps_ins`.
    pub(super) sensor_type: String,
    #[serde(rename = "RT_body_from_sensor")]
    pub(super) body_from_sensor: Option<Matrix>,
    /// `opencv_pinhole` or `mei`.
    pub(super) model: Option<String>,
    pub(super) image_resolution_px: Option<[usize; 2]>,
    pub(super) focal_length_px: Option<[f64; 2]>,
    pub(super) principal_point_px: Option<[f64; 2]>,
    /// k1 k2 p1 p2 k3
    pub(super) distortion_coeffs: Option<[f64; 5]>,
}

/// `sensor/radar/NAME/NAME_NNNNNNN.json`
#[derive(Debug, Deserialize)]
pub(super) struct RadarFile {
    pub(super) targets: Vec<Target>,
}

/// A detection.
#[derive(Debug, Clone, Copy, Deserialize)]
pub(super) struct Target {
    /// rad
    pub(super) azimuth: f64,
    /// rad
    pub(super) elevation: f64,
    /// m
    pub(super) range: f64,
    /// Raw range rate, m/s, positive when receding.
    pub(super) speed: f64,
    /// m^2
    pub(super) rcs: f64,
    /// dB
    pub(super) power: f64,
    /// dB
    pub(super) noise: f64,
}

/// `dynamic/box/3d_body/frame_NNNNNNN.json`, of which the time alone is read.
#[derive(Debug, Deserialize)]
pub(super) struct BoxFile {
    /// ns
    #[serde(rename = "Timestamp", deserialize_with = "nanoseconds")]
    pub(super) t_ns: i64,
}

/// `sensor/gnssins/egomotion.json`: by the frame's number, body to ECEF.
pub(super) type EgoMotionFile = BTreeMap<String, Matrix>;

/// `sensor/gnssins/egomotion2.json`: by the frame's number.
pub(super) type EgoMotion2File = BTreeMap<String, EgoPose>;

/// A pose in it.
#[derive(Debug, Deserialize)]
pub(super) struct EgoPose {
    /// Body to ECEF.
    #[serde(rename = "RT_ECEF_body")]
    pub(super) ecef_from_body: Matrix,
}

/// Whole nanoseconds, published as a text.
fn nanoseconds<'de, D: Deserializer<'de>>(deserializer: D) -> Result<i64, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Time {
        Text(String),
        Number(i64),
    }
    // Times lie within 146 years of 0, so that the difference of two is a time as well.
    let usable = |t_ns: &i64| t_ns.unsigned_abs() <= i64::MAX as u64 / 2;
    match Time::deserialize(deserializer)? {
        Time::Number(t_ns) => Some(t_ns).filter(usable).ok_or_else(|| D::Error::custom(t_ns.to_string())),
        Time::Text(text) => {
            let t_ns = text.parse().ok().filter(usable);
            t_ns.ok_or_else(|| D::Error::custom(format!("`{text}` as Timestamp")))
        }
    }
}
