//! The lists of sequences and their files.

use super::time::nanoseconds;
use crate::disk::json;
use crate::error::DataError;
use ralf_files::Kind;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Sequences by name, each with the list that it is from.
pub(super) type Listed = BTreeMap<String, (PathBuf, Info)>;

/// A list: sequences by split (`train`, `val`).
type List = BTreeMap<String, Vec<Info>>;

/// What a sequence consists of. Paths are relative to the data set's folder.
#[derive(Debug, Clone, Deserialize)]
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
#[derive(Debug, Clone, Deserialize)]
pub(super) struct Frame {
    pub(super) filepath: String,
    /// ns
    #[serde(rename = "time", deserialize_with = "nanoseconds")]
    pub(super) t_ns: i64,
    /// Of LiDARs: whether points were moved to the frame's time.
    #[serde(default, alias = "isCompensated")]
    pub(super) is_compensated: bool,
}

/// Adds the sequences of a list. One that an earlier list has as well is the same.
pub(super) fn read(list: &Path, prefix: &str, listed: &mut Listed) -> Result<(), DataError> {
    let found: List = json::read(list, Kind::Table, "sequences by split, with their files")?;
    for info in found.into_values().flatten() {
        listed.entry(format!("{prefix}{}", info.id)).or_insert_with(|| (list.to_owned(), info));
    }
    Ok(())
}
