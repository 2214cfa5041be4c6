//! Where the vehicle was: poses in the frame of the earth's centre.

use super::frames::number;
use super::raw::{EgoMotion2File, EgoMotionFile};
use crate::disk::files;
use crate::disk::json;
use crate::error::DataError;
use crate::read::rotation::{Matrix, rigid};
use ralf::space::{EgoMotion, PoseSample, Transform, going_on};
use ralf_files::Kind;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The motion of the two outermost poses goes on for so long beyond them, ns: points are measured from 68 ms before
/// their frame to 32 ms after it, and radar scans up to 160 ms before it. A single one tells none and is held.
const BEYOND_NS: i64 = 300_000_000;
/// ... and for so many of their steps at most.
const STEPS: i64 = 5;

/// The motion at the frames' times, and the file that tells it; `None` where there is none.
pub(super) fn read(
    folder: &Path,
    times: &BTreeMap<u64, i64>,
) -> Result<Option<(EgoMotion, PathBuf)>, DataError> {
    let folder = folder.join("sensor/gnssins");
    let expected = "poses by frame";
    let both = folder.join("egomotion2.json");
    let (file, matrices) = if files::exists(&both)? {
        let poses: EgoMotion2File = json::read(&both, Kind::Table, expected)?;
        (both, poses.into_iter().map(|(frame, pose)| (frame, pose.ecef_from_body)).collect())
    } else {
        let file = folder.join("egomotion.json");
        if !files::exists(&file)? {
            return Ok(None);
        }
        let matrices: EgoMotionFile = json::read(&file, Kind::Table, expected)?;
        (file, matrices)
    };
    let poses = poses(&file, &matrices, times)?;
    let motion = EgoMotion::new(Vec::new(), poses)
        .ok_or_else(|| DataError::content(&file, "poses", "one of a frame of this sequence", "none"))?;
    Ok(Some((motion, file)))
}

/// Poses in the vehicle's frame at the first of them: coordinates in the earth's have seven digits before the point.
fn poses(
    file: &Path,
    matrices: &BTreeMap<String, Matrix>,
    times: &BTreeMap<u64, i64>,
) -> Result<Vec<PoseSample>, DataError> {
    let mut by_frame: BTreeMap<u64, Transform> = BTreeMap::new();
    for (frame, matrix) in matrices {
        let found = || format!("`{frame}`");
        let n =
            number(frame).ok_or_else(|| DataError::content(file, "keys", "numbers of frames", found()))?;
        by_frame.insert(n, rigid(file, &format!("frame {frame}"), matrix)?);
    }
    let known = by_frame.iter().filter_map(|(frame, pose)| Some((*times.get(frame)?, pose)));
    let known: Vec<(i64, &Transform)> = known.collect();
    let Some((_, first)) = known.first() else { return Ok(Vec::new()) };
    let sample =
        |(t_ns, pose): &(i64, &Transform)| PoseSample { t_ns: *t_ns, odom_from_vehicle: first.inv_mul(pose) };
    Ok(going_on(known.iter().map(sample).collect(), BEYOND_NS, STEPS))
}
