//! The lists of sequences and their files.

use super::time::nanoseconds;
use crate::disk::json;
use crate::error::DataError;
use ralf_files::Kind;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A sequence with the list that it is from, or why nobody can tell which files are its.
pub(super) type Told = Result<(PathBuf, Info), DataError>;

/// Sequences by name.
pub(super) type Listed = BTreeMap<String, Told>;

/// A list: sequences by split (`train`, `val`).
type List = BTreeMap<String, Vec<Info>>;

/// What a sequence consists of. Paths are relative to the data set's folder.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Info {
    pub(super) id: String,
    #[serde(alias = "calibrationPath")]
    pub(super) calibration_path: String,
    #[serde(alias = "egoMotionPath")]
    pub(super) ego_motion_path: String,
    /// By anonymisation: `front_blur`, `front_dnat`.
    #[serde(default, alias = "cameraFrames")]
    pub(super) camera_frames: BTreeMap<String, Vec<Frame>>,
    /// `velodyne`.
    #[serde(default, alias = "lidarFrames")]
    pub(super) lidar_frames: BTreeMap<String, Vec<Frame>>,
    /// `front`; missing in downloads before the end of 2024.
    #[serde(default, alias = "radarFrames")]
    pub(super) radar_frames: Option<BTreeMap<String, Vec<Frame>>>,
}

/// A file of a sensor.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct Frame {
    pub(super) filepath: String,
    /// ns
    #[serde(rename = "time", deserialize_with = "nanoseconds")]
    pub(super) t_ns: i64,
    /// Of LiDARs: whether points were moved to the frame's time.
    #[serde(default, alias = "isCompensated")]
    pub(super) is_compensated: bool,
}

/// Adds the sequences of a list. One that is listed once more has to say the same: nobody could tell which is true.
pub(super) fn read(list: &Path, prefix: &str, listed: &mut Listed) -> Result<(), DataError> {
    let found: List = json::read(list, Kind::Table, "sequences by split, with their files")?;
    for info in found.into_values().flatten() {
        let place = format!("id `{}`", info.id);
        let told = listed
            .entry(format!("{prefix}{}", info.id))
            .or_insert_with(|| Ok((list.to_owned(), info.clone())));
        if let Ok((first, known)) = told
            && *known != info
        {
            let expected = format!("the files that {} lists for it", first.display());
            *told = Err(DataError::content(list, place, expected, "others"));
        }
    }
    Ok(())
}
