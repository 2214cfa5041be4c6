//! nuScenes as published: tables of the version folder `v1.0-*`, measurements under `samples` and `sweeps`, and the CAN
//! bus expansion where it is there.
//!
//! - A scene is a sequence. All sweeps and keyframes of all its sensors are in it, each with its own timestamp.
//! - No radar detection is dropped: of the quality fields that the devkit filters by (`invalid_state`, `dyn_prop`,
//!   `ambig_state`) all values pass, and all fields are kept. Two columns are appended, `doppler` and
//!   `doppler_compensated`: the radial parts of (`vx`, `vy`) and (`vx_comp`, `vy_comp`), for only these are measured.
//! - The vehicle frame is nuScenes' ego frame (rear axle, on the ground, x forward), odom its global frame.
//! - LiDAR points stay in nuScenes' LiDAR frame (x right, y forward), which the mounting takes care of. They are as
//!   published, not motion-corrected.
//! - Measurements that the tables list but the disk lacks (parts of the data set are published one by one) are left out
//!   of the timelines, with a warning.

mod can;
mod join;
mod pcd;
mod raw;
mod rig;
mod source;

pub(crate) use source::NuScenesOrigin;

use crate::disk::files::Folders;
use crate::error::DataError;
use crate::read::{Recording, SequenceReader};
use std::fs;
use std::path::{Path, PathBuf};

/// The format's name.
pub(crate) const NAME: &str = "nuscenes";

/// Opens the data set at the folder that holds `v1.0-*`, `samples` and `sweeps`.
///
/// Errors: no version folder or several, tables that are damaged or contradict each other, a sensor whose calibration
/// changes inside a scene, a scene without ego poses.
pub(crate) fn open(path: &Path) -> Result<Recording, DataError> {
    let version = version_folder(path)?;
    let tables: Vec<PathBuf> = join::TABLES.iter().map(|name| version.join(name)).collect();
    let mut folders = Folders::default();
    let mut sequences: Vec<Box<dyn SequenceReader>> = Vec::new();
    for scene in join::read_scenes(&version)? {
        sequences.push(Box::new(source::Scene::new(path, &tables, scene, &mut folders)?));
    }
    Ok(Recording { path: path.to_owned(), format: NAME, sequences })
}

/// Whether a folder looks like nuScenes.
pub(crate) fn recognises(path: &Path) -> bool {
    version_folders(path)
        .is_ok_and(|found| found.iter().any(|folder| folder.join("sample_data.json").is_file()))
}

/// The only folder `v1.0-*`.
fn version_folder(path: &Path) -> Result<PathBuf, DataError> {
    let mut found = version_folders(path)?;
    if let (1, Some(only)) = (found.len(), found.pop()) {
        return Ok(only);
    }
    let names: Vec<_> = version_folders(path)?
        .iter()
        .filter_map(|f| Some(f.file_name()?.to_string_lossy().into_owned()))
        .collect();
    let found = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
    Err(DataError::content(path, "folders", "exactly one version folder `v1.0-*`", found))
}

fn version_folders(path: &Path) -> Result<Vec<PathBuf>, DataError> {
    let mut found = Vec::new();
    for entry in fs::read_dir(path).map_err(DataError::io(path))? {
        let entry = entry.map_err(DataError::io(path))?;
        if entry.file_name().to_string_lossy().starts_with("v1.0-") && entry.path().is_dir() {
            found.push(entry.path());
        }
    }
    found.sort();
    Ok(found)
}

#[cfg(test)]
mod tests;
