//! Cameras whose images are published without distortion.

use super::join::Channel;
use crate::error::DataError;
use ralf::sensors::{Camera, Intrinsics};
use std::path::Path;

/// A plain pinhole; `tables` is the version folder, for errors.
pub(crate) fn pinhole(tables: &Path, channel: &Channel) -> Result<Camera, DataError> {
    let calibration = &channel.calibration;
    let [[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]] = calibration.intrinsic[..] else {
        return Err(DataError::content(
            &tables.join("calibrated_sensor.json"),
            format!("camera_intrinsic of {}", calibration.name),
            "[[fx, 0, cx], [0, fy, cy], [0, 0, 1]]",
            format!("{:?}", calibration.intrinsic),
        ));
    };
    let [width, height] = channel.image_size;
    Ok(Camera {
        name: calibration.name.clone(),
        vehicle_from_camera: calibration.vehicle_from_sensor,
        width,
        height,
        intrinsics: Intrinsics::Pinhole { focal: [fx, fy], center: [cx, cy], distortion: [0.0; 5] },
        views: Vec::new(),
    })
}
