//! A scene's sensors as the labeler wants them.

use super::join::Channel;
use super::raw::Modality;
use crate::error::DataError;
use crate::read::models::{ARS_408_21, HDL_32E};
use ralf::sensors::{Camera, Intrinsics, Rig};
use std::path::Path;

/// What a radar record holds, under the names of the file.
pub(super) const PCD_FIELDS: [&str; 18] = [
    "x",
    "y",
    "z",
    "dyn_prop",
    "id",
    "rcs",
    "vx",
    "vy",
    "vx_comp",
    "vy_comp",
    "is_quality_valid",
    "ambig_state",
    "x_rms",
    "y_rms",
    "invalid_state",
    "pdh0",
    "vx_rms",
    "vy_rms",
];

/// What is derived from them: the radial parts of the two velocities, m/s.
const DERIVED_FIELDS: [&str; 2] = ["doppler", "doppler_compensated"];

/// The rig of a scene; `tables` is the version folder, for errors.
pub(super) fn rig(tables: &Path, channels: &[Channel]) -> Result<Rig, DataError> {
    let fields: Vec<&str> = PCD_FIELDS.into_iter().chain(DERIVED_FIELDS).collect();
    let mut rig = Rig::default();
    for channel in channels {
        let (name, mounting) = (&channel.calibration.name, channel.calibration.vehicle_from_sensor);
        match channel.calibration.modality {
            Modality::Radar => rig.radars.push(ARS_408_21.mounted(name, &fields, mounting)),
            Modality::Lidar => rig.lidars.push(HDL_32E.mounted(name, mounting)),
            Modality::Camera => rig.cameras.push(camera(tables, channel)?),
        }
    }
    Ok(rig)
}

/// Images are published without distortion: a plain pinhole.
fn camera(tables: &Path, channel: &Channel) -> Result<Camera, DataError> {
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
