//! nuScenes as published: tables of the version folder `v1.0-*`, measurements under `samples` and `sweeps`, and the CAN
//! bus expansion where it is there.
//!
//! - A scene is a sequence. All sweeps and keyframes of all its sensors are in it, each with its own timestamp.
//! - No radar detection is dropped: of the quality fields that the devkit filters by (`invalid_state`, `dyn_prop`,
//!   `ambig_state`) all values pass, and all fields are kept. Two columns are appended, `doppler` and
//!   `doppler_compensated`: the radial parts of (`vx`, `vy`) and (`vx_comp`, `vy_comp`), for only these are measured.
//! - The vehicle frame is nuScenes' ego frame (rear axle, on the ground, x forward), odom its global frame.
//! - LiDAR points stay in nuScenes' LiDAR frame (x right, y forward), which the mounting takes care of. They are
//!   published motion-corrected to the end of the revolution, which is the scan's time, and without times of their own:
//!   `docs/recordings.md` tells how that is seen.
//! - Measurements that the tables list but the disk lacks (parts of the data set are published one by one) are left out
//!   of the timelines, with a warning. A radar's file that is missing while others of its scene are in the same folder
//!   (`samples/RADAR_FRONT`, `sweeps/RADAR_FRONT`) is a scan that can't be read.

mod can;
mod raw;
mod source;

use crate::disk::files::Folders;
use crate::error::DataError;
use crate::read::opened::Opened;
use crate::read::scene_tables::{self, Place, Scenes, lookup};
use crate::read::{Recording, truckscenes};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// The format's name.
pub(crate) const NAME: &str = "nuscenes";
/// The table that tells when and where scenes were recorded.
const LOG: &str = "log.json";

/// Opens the data set at the folder that holds `v1.0-*`, `samples` and `sweeps`, or at the folder `v1.0-*` beside them;
/// where names are given, those scenes.
///
/// Errors: no version folder or several, tables that are damaged or contradict each other, a sensor whose calibration
/// changes inside a scene. Of a scene that is named, or if all are such: no ego poses, a damaged CAN bus.
pub(crate) fn open(path: &Path, names: &[String]) -> Result<Recording, DataError> {
    let Place { root, version } = scene_tables::place(path, is_version, "v1.0-*")?;
    if version.join(truckscenes::TELLING).is_file() {
        let found = format!("{}, of MAN TruckScenes (--format {})", truckscenes::TELLING, truckscenes::NAME);
        return Err(DataError::content(&version, "tables", "those of nuScenes alone", found));
    }
    let mut tables: Vec<PathBuf> = scene_tables::TABLES.iter().map(|name| version.join(name)).collect();
    tables.push(version.join(LOG));
    tables.sort();
    let mut folders = Folders::default();
    let opened = Opened::of(scenes(&version)?.finish(), names, |_, record| {
        source::scene(&root, &version, &tables, record, &mut folders)
    })?;
    Ok(opened.recording(path, NAME, Vec::new()))
}

/// Whether a folder looks like nuScenes.
pub(crate) fn recognises(path: &Path) -> bool {
    scene_tables::is_one(path, is_version, "sample_data.json")
}

fn is_version(folder: &str) -> bool {
    folder.starts_with("v1.0-")
}

/// The scenes with their poses; their titles tell place and date.
fn scenes(version: &Path) -> Result<Scenes, DataError> {
    let mut logs = HashMap::new();
    scene_tables::for_each_row(&version.join(LOG), |row: raw::LogRow| {
        logs.insert(row.token, format!("{}, {}", row.location, row.date_captured));
        Ok(())
    })?;
    let mut scenes = scene_tables::read_scenes(version, |description, log| {
        Ok(format!("{description} ({})", lookup(&logs, log, LOG)?))
    })?;
    scenes.take_named_poses(version)?;
    Ok(scenes)
}

#[cfg(test)]
mod tests;
