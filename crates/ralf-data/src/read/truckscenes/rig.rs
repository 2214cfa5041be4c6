//! A scene's sensors as the labeler wants them.

use crate::error::DataError;
use crate::read::models::{ARS_548, GENERIC_LIDAR};
use crate::read::scene_tables::{Channel, Modality, pinhole};
use ralf::sensors::Rig;
use std::path::Path;

/// What a radar record holds, under the names of the file.
pub(super) const PCD_FIELDS: [&str; 7] = ["x", "y", "z", "vrel_x", "vrel_y", "vrel_z", "rcs"];

/// The rig of a scene; `tables` is the version folder, for errors.
pub(super) fn rig(tables: &Path, channels: &[Channel]) -> Result<Rig, DataError> {
    let fields: Vec<&str> = PCD_FIELDS.into_iter().chain(["doppler"]).collect();
    let mut rig = Rig::default();
    for channel in channels {
        let (name, mounting) = (&channel.calibration.name, channel.calibration.vehicle_from_sensor);
        match channel.calibration.modality {
            Modality::Radar => rig.radars.push(ARS_548.mounted(name, &fields, mounting)),
            Modality::Lidar => rig.lidars.push(GENERIC_LIDAR.mounted(name, mounting)),
            Modality::Camera => rig.cameras.push(pinhole(tables, channel)?),
            Modality::Other => {}
        }
    }
    Ok(rig)
}
