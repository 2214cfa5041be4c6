//! Which frames a sequence has, which files belong to them, and when they were.

use super::raw::BoxFile;
use crate::disk::json;
use crate::disk::{files, laz};
use crate::error::DataError;
use ralf_files::Kind;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// A sensor's files by the number of their frame.
pub(super) type Frames = BTreeMap<u64, PathBuf>;

/// The files `PREFIX_NNNNNNN.EXTENSION` of a folder; none where there is no such folder.
pub(super) fn list(folder: &Path, prefix: &str, extension: &str) -> Result<Frames, DataError> {
    let mut frames = Frames::new();
    for name in files::names(folder)? {
        let Some(stem) = name.strip_suffix(extension).and_then(|stem| stem.strip_suffix('.')) else {
            continue;
        };
        let digits = stem.strip_prefix(prefix).and_then(|rest| rest.strip_prefix('_'));
        let file = folder.join(&name);
        let Some(number) = digits.and_then(number) else {
            let expected = format!("{prefix}_NNNNNNN.{extension}");
            return Err(DataError::content(&file, "file name", expected, format!("`{name}`")));
        };
        if let Some(other) = frames.insert(number, file.clone()) {
            let expected = format!("one file of frame {number}");
            return Err(DataError::content(&file, "file name", expected, other.display().to_string()));
        }
    }
    Ok(frames)
}

/// The number that a text of digits alone is.
pub(super) fn number(digits: &str) -> Option<u64> {
    Some(digits).filter(|digits| digits.bytes().all(|b| b.is_ascii_digit()))?.parse().ok()
}

/// When each frame was, ns, and the files that tell it.
pub(super) struct FrameTimes {
    pub(super) times: BTreeMap<u64, i64>,
    /// The files of boxes; none where the LiDAR tells the times.
    pub(super) boxes: Vec<PathBuf>,
    pub(super) warning: Option<String>,
}

impl FrameTimes {
    /// From the boxes, if each of these frames has some; else from the LiDAR.
    pub(super) fn read(folder: &Path, frames: &BTreeSet<u64>, lidar: &Frames) -> Result<Self, DataError> {
        let box_folder = folder.join("dynamic/box/3d_body");
        let boxes = list(&box_folder, "frame", "json")?;
        let missing = frames.iter().filter(|frame| !boxes.contains_key(frame)).count();
        let found = if missing == 0 {
            Self::of_boxes(frames, &boxes)?
        } else {
            Self::of_lidar(folder, frames, lidar, missing)?
        };
        let mut pairs = found.times.iter().zip(found.times.iter().skip(1));
        match pairs.find(|((_, before), (_, after))| after <= before) {
            Some(((_, before), (frame, after))) => {
                let expected = format!("a time after {before} ns, that of the frame before");
                Err(DataError::content(folder, format!("frame {frame}"), expected, format!("{after} ns")))
            }
            None => Ok(found),
        }
    }

    fn of_boxes(frames: &BTreeSet<u64>, boxes: &Frames) -> Result<Self, DataError> {
        let used: Vec<(u64, PathBuf)> = boxes
            .iter()
            .filter(|(frame, _)| frames.contains(frame))
            .map(|(n, file)| (*n, file.clone()))
            .collect();
        let mut times = BTreeMap::new();
        for (frame, file) in &used {
            let BoxFile { t_ns } = json::read(file, Kind::Measurement, "boxes with a Timestamp in ns")?;
            times.insert(*frame, t_ns);
        }
        Ok(Self { times, boxes: used.into_iter().map(|(_, file)| file).collect(), warning: None })
    }

    fn of_lidar(
        folder: &Path,
        frames: &BTreeSet<u64>,
        lidar: &Frames,
        missing: usize,
    ) -> Result<Self, DataError> {
        let mut times = BTreeMap::new();
        for frame in frames {
            let untold = || {
                let expected = "boxes of every frame, or a LiDAR file of every frame, to tell their times";
                DataError::content(&folder.join("dynamic"), format!("frame {frame}"), expected, "neither")
            };
            let file = lidar.get(frame).ok_or_else(untold)?;
            let first = laz::read_first(file)?;
            let first =
                first.ok_or_else(|| DataError::content(file, "points", "a point with a time", "none"))?;
            times.insert(*frame, time_of_point(file, first.gps_time)?);
        }
        let warning = format!(
            "{missing} of {} frames have no boxes, whose timestamps are the frames' times: these are taken from the \
             LiDAR's first points",
            frames.len()
        );
        Ok(Self { times, boxes: Vec::new(), warning: Some(warning) })
    }
}

/// The time of a point as the files have it, ns.
pub(super) fn time_of_point(file: &Path, gps_time: f64) -> Result<i64, DataError> {
    if gps_time.abs() <= i64::MAX as f64 / 2.0 {
        return Ok(gps_time.round() as i64);
    }
    Err(DataError::content(file, "gps_time", "a time in ns", gps_time.to_string()))
}
