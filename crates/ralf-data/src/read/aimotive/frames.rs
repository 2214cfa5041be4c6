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

/// A frame is so much later than its LiDAR's first point, ns, as measured on the published sample. It counts where no
/// boxes tell it.
const AFTER_FIRST_POINT_NS: i64 = 67_600_000;
/// So many frames tell it of a sequence.
const COMPARED: usize = 15;

/// When each frame was, ns, and the files that tell it.
pub(super) struct FrameTimes {
    pub(super) times: BTreeMap<u64, i64>,
    /// The files of boxes that tell times.
    pub(super) boxes: Vec<PathBuf>,
    pub(super) warning: Option<String>,
}

impl FrameTimes {
    /// From the boxes; of frames without, from the LiDAR's first point, and where there is none, from those around.
    pub(super) fn read(folder: &Path, frames: &BTreeSet<u64>, lidar: &Frames) -> Result<Self, DataError> {
        let mut boxes = list(&folder.join("dynamic/box/3d_body"), "frame", "json")?;
        boxes.retain(|frame, _| frames.contains(frame));
        let mut times = BTreeMap::new();
        for (frame, file) in &boxes {
            let BoxFile { t_ns } = json::read(file, Kind::Measurement, "boxes with a Timestamp in ns")?;
            times.insert(*frame, t_ns);
        }
        let without: Vec<u64> = frames.iter().copied().filter(|frame| !times.contains_key(frame)).collect();
        let mut warning = None;
        if !without.is_empty() {
            let later_ns = after_first_point(&times, lidar)?;
            warning = Some(warning_of(&without, frames.len(), later_ns));
            add_by_lidar(&mut times, &without, lidar, later_ns)?;
            add_between(folder, &mut times, frames)?;
        }
        check_order(folder, &times)?;
        Ok(Self { times, boxes: boxes.into_values().collect(), warning })
    }
}

fn warning_of(without: &[u64], all: usize, later_ns: i64) -> String {
    let (missing, later_ms) = (without.len(), later_ns as f64 * 1e-6);
    format!(
        "{missing} of {all} frames have no boxes, whose timestamps are the frames' times: they are taken to be \
         {later_ms:.1} ms after the LiDAR's first point, or as far apart as the others"
    )
}

/// By how much frames are later than their LiDAR's first point: the median of those that have boxes, ns.
fn after_first_point(by_boxes: &BTreeMap<u64, i64>, lidar: &Frames) -> Result<i64, DataError> {
    let both = by_boxes.iter().filter_map(|(frame, t_ns)| Some((*t_ns, lidar.get(frame)?)));
    let mut later = Vec::new();
    for (t_ns, file) in both.take(COMPARED) {
        later.extend(first_point(file)?.map(|first| t_ns.saturating_sub(first)));
    }
    later.sort_unstable();
    Ok(later.get(later.len() / 2).copied().unwrap_or(AFTER_FIRST_POINT_NS))
}

fn add_by_lidar(
    times: &mut BTreeMap<u64, i64>,
    without: &[u64],
    lidar: &Frames,
    later_ns: i64,
) -> Result<(), DataError> {
    for frame in without {
        if let Some(first) = lidar.get(frame).map_or(Ok(None), |file| first_point(file))? {
            times.insert(*frame, first.saturating_add(later_ns));
        }
    }
    Ok(())
}

/// The time of frames of which neither boxes nor points tell it: as if numbers and times went by equal steps between
/// the two told ones around, or beyond the two outermost.
fn add_between(
    folder: &Path,
    times: &mut BTreeMap<u64, i64>,
    frames: &BTreeSet<u64>,
) -> Result<(), DataError> {
    let told: Vec<(u64, i64)> = times.iter().map(|(frame, t_ns)| (*frame, *t_ns)).collect();
    for frame in frames.iter().filter(|frame| !told.iter().any(|(known, _)| known == *frame)) {
        let after = told.partition_point(|(known, _)| known < frame);
        let first = after.saturating_sub(1).min(told.len().saturating_sub(2));
        let Some([(n0, t0), (n1, t1)]) = told.get(first..first + 2) else {
            let expected = "boxes or LiDAR files of two frames or more, to tell the frames' times";
            return Err(DataError::content(
                &folder.join("dynamic"),
                format!("frame {frame}"),
                expected,
                "none",
            ));
        };
        let share = (*frame as f64 - *n0 as f64) / (n1 - n0) as f64;
        times.insert(*frame, t0.saturating_add((share * t1.saturating_sub(*t0) as f64).round() as i64));
    }
    Ok(())
}

fn check_order(folder: &Path, times: &BTreeMap<u64, i64>) -> Result<(), DataError> {
    let mut pairs = times.iter().zip(times.iter().skip(1));
    match pairs.find(|((_, before), (_, after))| after <= before) {
        Some(((_, before), (frame, after))) => {
            let expected = format!("a time after {before} ns, that of the frame before");
            Err(DataError::content(folder, format!("frame {frame}"), expected, format!("{after} ns")))
        }
        None => Ok(()),
    }
}

/// When the first point of a LiDAR's file was measured, ns; `None` of a file without one.
fn first_point(file: &Path) -> Result<Option<i64>, DataError> {
    laz::read_first(file)?.map(|first| time_of_point(file, first.gps_time)).transpose()
}

/// The time of a point as the files have it, ns.
pub(super) fn time_of_point(file: &Path, gps_time: f64) -> Result<i64, DataError> {
    if gps_time.abs() <= i64::MAX as f64 / 2.0 {
        return Ok(gps_time.round() as i64);
    }
    Err(DataError::content(file, "gps_time", "a time in ns", gps_time.to_string()))
}
