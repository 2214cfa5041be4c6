//! RadarScenes as published, with the labels of its authors or those of clutter-ds: a folder per sequence, with an HDF5
//! file of detections and odometry, and a JSON file that says which rows are which scan.
//!
//! - The path is the data set's folder, its `data`, or one sequence. A sequence is named after its folder.
//! - A scene of `scenes.json` is a scan of one of the four radars, at its own time. All rows of the table must belong
//!   to one. Columns are as published: `range_sc` is `range`, `azimuth_sc` is `azimuth`, `vr` is `doppler`, the raw
//!   range rate, `vr_compensated` is `doppler_compensated`, which is not a number where its authors had no pose; `rcs`
//!   in dBsm.
//! - There is no LiDAR, and the camera, which documents, isn't calibrated: tracking alone says something, and Doppler.
//! - Poses are those of the odometry, relative to the first; speed and yaw rate are kept as wheel odometry. They lead
//!   on where radars measure a little before or after.
//! - Radars don't measure elevation and have no published height: they lie on the road.
//! - `label_id` is the truth, never a column that labels could be made from: [`labels`] says what becomes of it.

mod labels;
mod raw;
mod source;
mod tables;

use crate::disk::files;
use crate::error::DataError;
use crate::read::Recording;
use crate::read::incomplete::{named, none_whole, parted};
use crate::read::last_read::LastRead;
use crate::read::opened::Opened;
use source::Drive;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The format's name.
pub(crate) const NAME: &str = "radarscenes";
/// A sequence's table of detections and odometry.
const TABLES: &str = "radar_data.h5";
/// Which rows are which scan.
const SCENES: &str = "scenes.json";

/// Opens the data set or a sequence; where names are given, those.
///
/// Errors: no sequence. Of one that is named, or if all are such: damaged or contradictory files.
pub(crate) fn open(path: &Path, names: &[String]) -> Result<Recording, DataError> {
    let (folders, incomplete) = parted(sequence_folders(path)?, missing);
    if folders.is_empty() {
        let expected = format!("sequences with `{TABLES}` and `{SCENES}`");
        return Err(none_whole(path, expected, &incomplete));
    }
    let tables = Arc::new(LastRead::new(tables::detections, 2));
    let folders = folders.into_iter().map(|folder| (named(&folder), folder)).collect();
    let opened = Opened::of(folders, names, |_, folder| Drive::new(&folder, tables.clone()))?;
    Ok(opened.recording(path, NAME, incomplete))
}

/// Whether a folder looks like RadarScenes.
pub(crate) fn recognises(path: &Path) -> bool {
    sequence_folders(path).is_ok_and(|found| found.iter().any(|folder| missing(folder).is_none()))
}

/// What a folder lacks of a sequence.
fn missing(folder: &Path) -> Option<&'static str> {
    [TABLES, SCENES].into_iter().find(|name| !folder.join(name).is_file())
}

/// The folders of all sequences, whole or in part: `[data/]SEQUENCE`.
fn sequence_folders(path: &Path) -> Result<Vec<PathBuf>, DataError> {
    let is_sequence = |folder: &PathBuf| [TABLES, SCENES].iter().any(|name| folder.join(name).is_file());
    let path = path.to_owned();
    if is_sequence(&path) {
        return Ok(vec![path]);
    }
    let data = path.join("data");
    let top = if data.is_dir() { data } else { path };
    let folders = files::folders(&top)?.into_iter().map(|name| top.join(name));
    Ok(folders.filter(is_sequence).collect())
}

#[cfg(test)]
mod tests;
