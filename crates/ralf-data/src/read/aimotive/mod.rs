//! aiMotive's multimodal data set as published: a folder per sequence, a file per sensor and frame.
//!
//! - The path is a sequence's folder, one of sequences (an environment such as `highway`), or what holds `train` and
//!   `val`. A sequence is named after its folder.
//! - All files of a frame have its number. A frame's time is the `Timestamp` of its boxes, ns, the clock that the
//!   LiDAR's points have; where a measured frame has no such file, it is as much later than its LiDAR's first point as
//!   the others are, with a warning. The times in `egomotion2.json` are of other clocks and not used.
//! - Radar scans have no times of their own and get their frame's. `corrections.NAME.time_offset_ms` of the settings
//!   says when they were truly made. Columns are as published (`speed` is `doppler`, the raw range rate; `rcs`, in
//!   square metres, is `rcs_linear`), and two are derived: `rcs` in dBsm and `snr`, power minus noise, in dB.
//! - LiDAR points are as measured, each at its own time, in the vehicle's frame, that aiMotive calls body. They go to
//!   the LiDAR's frame, and to the frame's time once the vehicle's motion is known. Each keeps its time.
//! - The vehicle's poses are `RT body -> ECEF` of `egomotion2.json` or `egomotion.json`, relative to the first. Where
//!   there is neither, the motion is unknown: a trajectory or the radars' range rates tell it.
//! - Cameras are pinholes with OpenCV's distortion. Fisheyes of the model `mei` are left out, with a warning.

mod calibration;
mod cloud;
mod frames;
mod motion;
mod raw;
mod source;

use crate::disk::files;
use crate::error::DataError;
use crate::read::Recording;
use crate::read::incomplete::{named, none_whole, parted};
use crate::read::opened::Opened;
use std::path::{Path, PathBuf};

/// The format's name.
pub(crate) const NAME: &str = "aimotive";
/// A sequence's calibration.
const CALIBRATION: &str = "sensor/calibration/calibration.json";
/// The folder of its radars' folders.
const RADARS: &str = "sensor/radar";
/// The folders in a sequence's folder.
const PARTS: [&str; 2] = ["sensor", "dynamic"];

/// Opens a sequence, the sequences of an environment, or all of them; where names are given, those.
///
/// Errors: no sequence, two of one name. Of one that is named, or if all are such: damaged or contradictory metadata,
/// frames whose time nobody tells.
pub(crate) fn open(path: &Path, names: &[String]) -> Result<Recording, DataError> {
    let mut folders = sequence_folders(path)?;
    folders.sort_by(|a, b| a.file_name().cmp(&b.file_name()));
    if let Some(pair) = folders.windows(2).find(|pair| pair[0].file_name() == pair[1].file_name()) {
        let found = pair[1].display().to_string();
        return Err(DataError::content(&pair[0], "name", "a name that no other sequence has", found));
    }
    let (folders, incomplete) = parted(folders, missing);
    if folders.is_empty() {
        return Err(none_whole(path, format!("sequences with `{CALIBRATION}` and `{RADARS}`"), &incomplete));
    }
    let folders = folders.into_iter().map(|folder| (named(&folder), folder)).collect();
    let opened = Opened::of(folders, names, |_, folder| source::drive(&folder))?;
    Ok(opened.recording(path, NAME, incomplete))
}

/// Whether a folder looks like aiMotive.
pub(crate) fn recognises(path: &Path) -> bool {
    sequence_folders(path).is_ok_and(|found| found.iter().any(|folder| missing(folder).is_none()))
}

/// What a folder lacks of a sequence.
fn missing(folder: &Path) -> Option<&'static str> {
    match (folder.join(CALIBRATION).is_file(), folder.join(RADARS).is_dir()) {
        (false, _) => Some(CALIBRATION),
        (true, false) => Some(RADARS),
        (true, true) => None,
    }
}

/// Whether a folder holds some of a sequence.
fn is_sequence(folder: &Path) -> bool {
    PARTS.iter().any(|part| folder.join(part).is_dir())
}

/// The folders of all sequences, whole or in part: `[data/][train/ | val/][ENVIRONMENT/]SEQUENCE`.
fn sequence_folders(path: &Path) -> Result<Vec<PathBuf>, DataError> {
    if is_sequence(path) {
        return Ok(vec![path.to_owned()]);
    }
    let data = path.join("data");
    let top = if data.is_dir() { &data } else { path };
    let splits = ["train", "val"].map(|split| top.join(split)).into_iter().filter(|split| split.is_dir());
    let mut parents: Vec<PathBuf> = splits.collect();
    if parents.is_empty() {
        parents.push(top.to_owned());
    }
    let mut found = Vec::new();
    for folder in parents.iter().map(|parent| below(parent)).collect::<Result<Vec<_>, _>>()?.concat() {
        if is_sequence(&folder) {
            found.push(folder);
        } else {
            found.extend(below(&folder)?.into_iter().filter(|folder| is_sequence(folder)));
        }
    }
    Ok(found)
}

fn below(folder: &Path) -> Result<Vec<PathBuf>, DataError> {
    Ok(files::folders(folder)?.into_iter().map(|name| folder.join(name)).collect())
}

#[cfg(test)]
mod tests;
