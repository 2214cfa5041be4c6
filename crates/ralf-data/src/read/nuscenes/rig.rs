//! A scene's sensors as the labeler wants them.

use crate::error::DataError;
use crate::read::models::{ARS_408_21, HDL_32E};
use crate::read::scene_tables::{Channel, Modality, pinhole};
use ralf::sensors::Rig;
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
            Modality::Camera => rig.cameras.push(pinhole(tables, channel)?),
            Modality::Other => {}
        }
    }
    Ok(rig)
}
