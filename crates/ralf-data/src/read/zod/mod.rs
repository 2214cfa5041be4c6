//! Zenseact Open Dataset, its Sequences and Drives as published: one front radar, LiDARs merged to one, one fisheye
//! camera. What is read and derived: `docs/zod.md`. The Frames have no radar and are not read.
//!
//! - The path holds `trainval-sequences-*.json` or `trainval-drives-*.json`, which list the files of each sequence;
//!   those whose calibration is on disk are read. A sequence has its number for a name, a drive `drive_` before it.
//! - The vehicle frame is ZOD's ego frame, lowered from the rear axle to the road.
//! - All scans of the radar lie in one file, and are rows with the same `scan_index`; a scan's time is its first row's,
//!   and scans with rows of several times are warned of. No row is dropped, whatever its `validity`; `range_rate` is
//!   `doppler`, the raw range rate.
//! - LiDAR points carry the time at which each was measured and are moved to the scan's with the poses, unless the list
//!   says that they are compensated. Points on the own roof, which ZOD's own tools leave out, are no returns.

mod calibration;
mod info;
mod lidar;
mod motion;
mod radar;
mod source;
mod time;

use crate::disk::files;
use crate::error::DataError;
use crate::read::Recording;
use crate::read::opened::Opened;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The format's name.
pub(crate) const NAME: &str = "zod";
/// What the lists' names begin with, and what stands before the name of a sequence out of them.
const LISTS: [(&str, &str); 2] = [("trainval-sequences-", ""), ("trainval-drives-", "drive_")];

/// Opens the data set at the folder that holds the lists; where names are given, those sequences.
///
/// Errors: no list or damaged ones, none of the listed sequences on disk. Of a sequence that is named, or if all are
/// such: calibrations and poses that are none, lists that contradict each other.
pub(crate) fn open(path: &Path, names: &[String]) -> Result<Recording, DataError> {
    let mut listed = info::Listed::default();
    for (list, prefix) in lists(path)? {
        info::read(&list, prefix, &mut listed)?;
    }
    let radar_files = Arc::new(radar::radar_files());
    let mut found = Vec::new();
    for (name, told) in listed {
        let is_there = |info: &info::Info| files::exists(&path.join(&info.calibration_path));
        if told.as_ref().map_or(Ok(true), |(_, info)| is_there(info))? {
            found.push((name, told));
        }
    }
    if found.is_empty() {
        return Err(DataError::content(
            path,
            "sequences",
            "the files of at least one that is listed",
            "none",
        ));
    }
    let open = |name: &str, told: info::Told| {
        let (list, info) = told?;
        source::sequence(path, name, &list, info, &radar_files)
    };
    Ok(Opened::of(found, names, open)?.recording(path, NAME, Vec::new()))
}

/// Whether a folder looks like ZOD's Sequences or Drives.
pub(crate) fn recognises(path: &Path) -> bool {
    lists(path).is_ok_and(|found| !found.is_empty())
}

/// The lists, and what stands before the names of their sequences.
fn lists(path: &Path) -> Result<Vec<(PathBuf, &'static str)>, DataError> {
    let names = files::names(path)?;
    let list = |name: &String| {
        let (_, prefix) = LISTS.iter().find(|(begin, _)| name.starts_with(begin))?;
        name.ends_with(".json").then(|| (path.join(name), *prefix))
    };
    Ok(names.iter().filter_map(list).collect())
}

#[cfg(test)]
mod tests;
