//! MAN TruckScenes as published: tables that look like nuScenes', six radars, six LiDARs and four cameras on a lorry
//! whose cab moves against its chassis, and which may pull a trailer. What is read and derived: `docs/truckscenes.md`.
//!
//! - A scene is a sequence. All sweeps and keyframes that are on disk are in it, each with its own timestamp; many
//!   copies lack `sweeps`, which the tables list all the same.
//! - `ego_pose_token` names a pose near a measurement and not the one of its time. Poses are those of the table
//!   `ego_pose` by their own timestamps, a scene's by time, and relative to its first: their coordinates have seven
//!   digits before the point.
//! - Speed and yaw rate are the cab's, which the radars move with (`ego_motion_cabin`), else the chassis'.
//! - The radars' `vrel_x`, `vrel_y` and `vrel_z` are the relative radial velocity as a vector. One column is derived:
//!   `doppler`, its part along the ray. No detection is dropped; one at (0, 0, 0) has no place.
//! - LiDAR points carry the time at which each was measured. They are moved to the scan's time with the poses.
//! - There is no log, and no map. A trailer (`vehicle.ego_trailer`) is part of what the sensors see.

mod motion;
mod source;

use crate::disk::files::Folders;
use crate::error::DataError;
use crate::read::Recording;
use crate::read::opened::Opened;
use crate::read::scene_tables::{self, Place};
use std::path::{Path, PathBuf};

/// The format's name.
pub(crate) const NAME: &str = "truckscenes";
/// The table that nuScenes has not.
pub(crate) const TELLING: &str = "ego_motion_chassis.json";

/// Opens the data set at the folder that holds `v1.2-*` (or an earlier version), `samples` and maybe `sweeps`, or at
/// the folder `v1.2-*` beside these; where names are given, those scenes.
///
/// Errors: no version folder or several, tables that are damaged or contradict each other, a sensor whose calibration
/// changes inside a scene. Of a scene that is named, or if all are such: no poses.
pub(crate) fn open(path: &Path, names: &[String]) -> Result<Recording, DataError> {
    let Place { root, version } = scene_tables::place(path, is_version, "vN.N-mini, -trainval or -test")?;
    let mut scenes = scene_tables::read_scenes(&version, |description, _| Ok(description.to_owned()))?;
    let motion = motion::Motion::read(&version, &mut scenes.records)?;
    let mut tables: Vec<PathBuf> = scene_tables::TABLES.iter().map(|name| version.join(name)).collect();
    tables.extend(motion.table);
    tables.sort();
    let mut odometry = motion.odometry;
    let mut folders = Folders::default();
    let opened = Opened::of(scenes.finish(), names, |name, record| {
        let odometry = odometry.remove(name).unwrap_or_default();
        source::scene(&root, &version, &tables, record, odometry, &mut folders)
    })?;
    Ok(opened.recording(path, NAME, Vec::new()))
}

/// Whether a folder looks like MAN TruckScenes.
pub(crate) fn recognises(path: &Path) -> bool {
    scene_tables::is_one(path, is_version, TELLING)
}

/// `v1.2-mini`: two numbers and a part of the data set.
fn is_version(folder: &str) -> bool {
    let number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let parts = folder.strip_prefix('v').and_then(|rest| rest.split_once('-'));
    parts.and_then(|(version, _)| version.split_once('.')).is_some_and(|(a, b)| number(a) && number(b))
}

#[cfg(test)]
mod tests;
