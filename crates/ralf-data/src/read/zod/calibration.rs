//! Sensors out of a sequence's calibration.

use super::radar::RADAR_FIELDS;
use crate::disk::json;
use crate::error::DataError;
use crate::read::models::{GENERIC_RADAR, VLS_128};
use crate::read::rotation::{Matrix, mounting, rigid};
use ralf::sensors::{Camera, Intrinsics, Lidar, Radar};
use ralf::space::Transform;
use ralf_files::Kind;
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The ego frame lies at the rear axle, this far above the road, m: what the tyres of the cars that recorded (Volvo
/// XC90) have for a radius under load.
const AXLE_ABOVE_ROAD: f64 = 0.36;

/// The vehicle frame's origin on the road below the axle.
pub(super) fn vehicle_from_ego() -> Transform {
    Transform::translation(0.0, 0.0, AXLE_ABOVE_ROAD)
}

/// The file.
#[derive(Deserialize)]
struct CalibrationFile {
    #[serde(rename = "FC")]
    front: Front,
}

/// The front camera, and the sensors that are calibrated with it: poses in the ego frame.
#[derive(Deserialize)]
struct Front {
    extrinsics: Matrix,
    lidar_extrinsics: Matrix,
    /// Missing in downloads before May 2025.
    radar_extrinsics: Option<Matrix>,
    intrinsics: [[f64; 3]; 3],
    /// Kannala-Brandt.
    distortion: [f64; 4],
    image_dimensions: [f64; 2],
}

/// How the sensors are mounted.
pub(super) struct Calibration {
    file: PathBuf,
    front: Front,
}

impl Calibration {
    pub(super) fn read(file: &Path) -> Result<Self, DataError> {
        let read: CalibrationFile =
            json::read(file, Kind::Settings, "the calibration of the front camera, `FC`")?;
        Ok(Self { file: file.to_owned(), front: read.front })
    }

    fn mounting(&self, key: &str, matrix: &Matrix) -> Result<Transform, DataError> {
        let place = format!("FC, {key}");
        let ego_from_sensor = rigid(&self.file, &place, matrix)?;
        Ok(vehicle_from_ego() * mounting(&self.file, &place, ego_from_sensor)?)
    }

    /// The radar; `None` where the calibration lacks it.
    pub(super) fn radar(&self) -> Result<Option<Radar>, DataError> {
        let Some(matrix) = &self.front.radar_extrinsics else { return Ok(None) };
        let mounting = self.mounting("radar_extrinsics", matrix)?;
        Ok(Some(GENERIC_RADAR.mounted("radar_front", &RADAR_FIELDS, mounting)))
    }

    pub(super) fn lidar(&self) -> Result<Lidar, DataError> {
        let mounting = self.mounting("lidar_extrinsics", &self.front.lidar_extrinsics)?;
        Ok(VLS_128.mounted("lidar_velodyne", mounting))
    }

    pub(super) fn camera(&self) -> Result<Camera, DataError> {
        let Front { extrinsics, intrinsics, distortion, image_dimensions, .. } = &self.front;
        let [[fx, _, cx], [_, fy, cy], _] = *intrinsics;
        let sizes = image_dimensions.map(|size| size as usize);
        if sizes.contains(&0) || !(fx > 0.0 && fy > 0.0) {
            let found = format!("{image_dimensions:?} px, {fx} and {fy} px");
            let place = "FC, image_dimensions and intrinsics";
            return Err(DataError::content(&self.file, place, "numbers above 0", found));
        }
        Ok(Camera {
            name: "camera_front".to_owned(),
            vehicle_from_camera: self.mounting("extrinsics", extrinsics)?,
            width: sizes[0],
            height: sizes[1],
            intrinsics: Intrinsics::KannalaBrandt {
                focal: [fx, fy],
                center: [cx, cy],
                distortion: *distortion,
            },
            views: Vec::new(),
        })
    }
}
