//! Sensors out of `calibration.json`.

use super::raw::{Calibration, Sensor};
use crate::error::DataError;
use crate::read::layout::is_folder_name;
use crate::read::models::{PANDAR64, UMRR_11};
use crate::read::rotation::{mounting, rigid};
use ralf::sensors::{Camera, Intrinsics, Lidar, Radar};
use ralf::space::Transform;
use std::path::Path;

/// The columns of a radar's scan, in the order in which the source gives them.
const RADAR_FIELDS: [&str; 9] =
    ["azimuth", "elevation", "range", "doppler", "rcs_linear", "power", "noise", "rcs", "snr"];

/// The calibration of one sensor, and what to call it in errors.
pub(super) struct Calibrated<'a> {
    file: &'a Path,
    name: &'a str,
    sensor: &'a Sensor,
}

impl<'a> Calibrated<'a> {
    /// Of the sensor of this name, which must be of this type.
    pub(super) fn find(
        file: &'a Path,
        calibration: &'a Calibration,
        name: &'a str,
        sensor_type: &str,
    ) -> Result<Self, DataError> {
        let wrong = |found: String| Err(DataError::content(file, name, format!("a {sensor_type}"), found));
        match calibration.get(name) {
            None => wrong("no such sensor".to_owned()),
            Some(_) if !is_folder_name(name) => wrong("a name that no folder can have".to_owned()),
            Some(sensor) if sensor.sensor_type != sensor_type => wrong(format!("`{}`", sensor.sensor_type)),
            Some(sensor) => Ok(Self { file, name, sensor }),
        }
    }

    /// Of the only LiDAR.
    pub(super) fn only_lidar(file: &'a Path, calibration: &'a Calibration) -> Result<Self, DataError> {
        let lidars: Vec<&str> = calibration
            .iter()
            .filter(|(_, s)| s.sensor_type == "lidar")
            .map(|(name, _)| name.as_str())
            .collect();
        match lidars[..] {
            [name] => Self::find(file, calibration, name, "lidar"),
            _ => {
                let found = if lidars.is_empty() { "none".to_owned() } else { lidars.join(", ") };
                Err(DataError::content(file, "sensors", "one LiDAR", found))
            }
        }
    }

    /// Whether the lens is aiMotive's fisheye, of which RALF has no model.
    pub(super) fn is_mei(&self) -> bool {
        self.sensor.model.as_deref() == Some("mei")
    }

    pub(super) fn radar(&self) -> Result<Radar, DataError> {
        Ok(UMRR_11.mounted(self.name, &RADAR_FIELDS, self.vehicle_from_sensor()?))
    }

    pub(super) fn lidar(&self) -> Result<Lidar, DataError> {
        Ok(PANDAR64.mounted(self.name, self.vehicle_from_sensor()?))
    }

    pub(super) fn camera(&self) -> Result<Camera, DataError> {
        let model = self.present("model", self.sensor.model.as_deref())?;
        if model != "opencv_pinhole" {
            return Err(self.error("model", "`opencv_pinhole` or `mei`", format!("`{model}`")));
        }
        let [width, height] = self.present("image_resolution_px", self.sensor.image_resolution_px)?;
        let focal = self.present("focal_length_px", self.sensor.focal_length_px)?;
        let center = self.present("principal_point_px", self.sensor.principal_point_px)?;
        let distortion = self.present("distortion_coeffs", self.sensor.distortion_coeffs)?;
        if width == 0 || height == 0 || focal.iter().any(|value| *value <= 0.0) {
            let found = format!("{width} x {height} px, {focal:?}");
            return Err(self.error("image_resolution_px, focal_length_px", "numbers above 0", found));
        }
        Ok(Camera {
            name: self.name.to_owned(),
            vehicle_from_camera: self.vehicle_from_sensor()?,
            width,
            height,
            intrinsics: Intrinsics::Pinhole { focal, center, distortion },
            views: Vec::new(),
        })
    }

    fn vehicle_from_sensor(&self) -> Result<Transform, DataError> {
        let matrix = self.present("RT_body_from_sensor", self.sensor.body_from_sensor)?;
        let place = format!("{}, RT_body_from_sensor", self.name);
        mounting(self.file, &place, rigid(self.file, &place, &matrix)?)
    }

    fn present<T>(&self, key: &str, value: Option<T>) -> Result<T, DataError> {
        value.ok_or_else(|| self.error(key, "a value", "none".to_owned()))
    }

    fn error(&self, key: &str, expected: &str, found: String) -> DataError {
        DataError::content(self.file, format!("{}, {key}", self.name), expected, found)
    }
}
