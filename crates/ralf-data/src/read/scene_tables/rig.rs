//! A scene's sensors as the labeler wants them. Images are published without distortion.

use super::join::Channel;
use super::raw::Modality;
use crate::error::DataError;
use crate::read::models::{LidarModel, RadarModel};
use ralf::sensors::{Camera, Intrinsics, Rig};
use std::path::Path;

/// What a format says of all its sensors.
pub(crate) struct Models<'a> {
    /// The type of its radars.
    pub(crate) radar: RadarModel,
    /// The radars' columns.
    pub(crate) fields: &'a [&'a str],
    /// The type of its LiDARs.
    pub(crate) lidar: LidarModel,
}

impl Models<'_> {
    /// The rig of a scene; `tables` is the version folder, for errors.
    pub(crate) fn rig(&self, tables: &Path, channels: &[Channel]) -> Result<Rig, DataError> {
        let mut rig = Rig::default();
        for channel in channels {
            let (name, mounting) = (&channel.calibration.name, channel.calibration.vehicle_from_sensor);
            match channel.calibration.modality {
                Modality::Radar => rig.radars.push(self.radar.mounted(name, self.fields, mounting)),
                Modality::Lidar => rig.lidars.push(self.lidar.mounted(name, mounting)),
                Modality::Camera => rig.cameras.push(pinhole(tables, channel)?),
                Modality::Other => {}
            }
        }
        Ok(rig)
    }
}

/// A plain pinhole; `tables` is the version folder, for errors.
fn pinhole(tables: &Path, channel: &Channel) -> Result<Camera, DataError> {
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
