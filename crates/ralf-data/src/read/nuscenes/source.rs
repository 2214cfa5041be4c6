//! A scene as a sequence: what its files hold.

use super::can;
use crate::disk::files::Folders;
use crate::disk::pcd::Pcd;
use crate::error::DataError;
use crate::read::file_sequence::{FileFormat, FileSequence};
use crate::read::measured_files::lidar_rows;
use crate::read::models::{ARS_408_21, HDL_32E};
use crate::read::radial::radial;
use crate::read::scene_tables::{Measurements, Models, SceneRecord, TableOrigin};
use ralf::sensors::{DepthOutput, Lidar, LidarScan, Sequence};
use ralf::space::EgoMotion;
use std::any::Any;
use std::path::{Path, PathBuf};

/// What a radar record holds, under the names of the file.
const PCD_FIELDS: [&str; 18] = [
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

/// How the files of a scene are read, and what the tables call its scans.
pub(super) struct NuScenes(TableOrigin);

/// A scene with what is on disk of what the tables list. `tables` lie in the folder `version`.
pub(super) fn scene(
    dataset: &Path,
    version: &Path,
    tables: &[PathBuf],
    record: SceneRecord,
    folders: &mut Folders,
) -> Result<FileSequence<NuScenes>, DataError> {
    record.check_poses(version)?;
    let SceneRecord { name, title, channels, poses } = record;
    let fields = [&PCD_FIELDS[..], &DERIVED_FIELDS].concat();
    let rig = Models { radar: ARS_408_21, fields: &fields, lidar: HDL_32E }.rig(version, &channels)?;
    let can = can::file(dataset, &name);
    let odometry = can.as_deref().map(can::read).transpose()?.unwrap_or_default();
    let motion = EgoMotion::new(odometry, poses)
        .ok_or_else(|| DataError::content(dataset, format!("scene `{name}`"), "ego poses", "none"))?;
    let mut found = Measurements::find(dataset, channels, folders)?;
    let format = NuScenes(found.origin(version));
    let Measurements { times, files, warnings, .. } = found;
    let sequence = Sequence { name, title, rig, times, motion, depth_output: DepthOutput::default() };
    let further = tables.iter().cloned().chain(can).collect();
    Ok(FileSequence { sequence, files, further, warnings, format })
}

impl FileFormat for NuScenes {
    fn radar_columns(&self, file: &Path, _: usize, _: usize) -> Result<Vec<Vec<f32>>, DataError> {
        radar_columns(&Pcd::read(file)?)
    }

    fn lidar_scan(&self, file: &Path, _: &Lidar, t_ns: i64) -> Result<LidarScan, DataError> {
        // The fifth column is the ring.
        lidar_rows::<5>(file, t_ns)
    }

    fn origin(&self) -> Option<&dyn Any> {
        Some(&self.0)
    }
}

/// The columns of [`PCD_FIELDS`] and the two derived ones.
fn radar_columns(pcd: &Pcd) -> Result<Vec<Vec<f32>>, DataError> {
    let mut columns = PCD_FIELDS.iter().map(|name| pcd.column(name)).collect::<Result<Vec<_>, _>>()?;
    let [x, y, id] = [0, 1, 4].map(|column: usize| columns[column].as_slice());
    // What nuScenes writes for a scan that saw nothing, as PCD knows no clouds without points.
    if let ([x], [y], [id]) = (x, y, id)
        && x.is_nan()
        && y.is_nan()
        && *id == -1.0
    {
        columns.iter_mut().for_each(Vec::clear);
    }
    for (vx, vy) in [(6, 7), (8, 9)] {
        columns.push(radial(&columns[0], &columns[1], &columns[vx], &columns[vy]));
    }
    Ok(columns)
}
