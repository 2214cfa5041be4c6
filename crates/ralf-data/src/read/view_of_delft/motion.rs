//! The vehicle's motion out of the frames' poses.

use super::calibration::{Mounting, odom_from_vehicle};
use super::raw::{FRAME_NS, Frame, read_odom_from_camera};
use crate::error::DataError;
use ralf::space::{EgoMotion, PoseSample, going_on};
use std::path::{Path, PathBuf};

/// A pose this far from the frame before belongs to another drive, m: half of it would be 25 m/s.
const LARGEST_STEP: f64 = 5.0;
/// So does one that is turned by more, rad: no car turns by 2 rad/s.
const LARGEST_TURN: f64 = 0.2;
/// Beyond the outermost poses the motion goes on for so many of their steps: clips begin with a frame or two that have
/// none.
const STEPS: i64 = 5;

/// The motion, and the files that tell it. Frames without a pose lie between others, and a warning counts them.
///
/// Errors: no folder of poses, a pose that is no rigid transform, none at all.
pub(super) fn read(
    folder: &Path,
    frames: &[Frame],
    mounting: &Mounting,
    warnings: &mut Vec<String>,
) -> Result<(EgoMotion, Vec<PathBuf>), DataError> {
    if !folder.is_dir() {
        let expected = "a pose per frame, as without them the vehicle's motion is unknown";
        return Err(DataError::content(folder, "files", expected, "no such folder"));
    }
    let (mut poses, mut files, mut without) = (Vec::new(), Vec::new(), Vec::new());
    for frame in frames {
        let file = folder.join(format!("{}.json", frame.stem));
        match read_odom_from_camera(&file)? {
            Some(matrix) => {
                let odom_from_vehicle = odom_from_vehicle(&file, &matrix, mounting)?;
                poses.push(PoseSample { t_ns: frame.time_ns(), odom_from_vehicle });
                files.push(file);
            }
            None => without.push(frame),
        }
    }
    warn_of_jumps(&poses, warnings);
    if let Some(first) = without.first() {
        warnings.push(format!(
            "{} of {} frames have no pose ({} first): the vehicle's motion there is that of the frames around",
            without.len(),
            frames.len(),
            first.stem
        ));
    }
    let lacks_end = [frames.first(), frames.last()].into_iter().flatten().any(|end| without.contains(&end));
    let poses = if lacks_end { going_on(poses, STEPS * FRAME_NS, STEPS) } else { poses };
    let motion = EgoMotion::new(Vec::new(), poses)
        .ok_or_else(|| DataError::content(folder, "poses", "one per frame", "none"))?;
    Ok((motion, files))
}

/// Each drive has an odom frame of its own, and where a drive begins, its poses err now and then.
fn warn_of_jumps(poses: &[PoseSample], warnings: &mut Vec<String>) {
    for pair in poses.windows(2) {
        let [before, after] = [&pair[0], &pair[1]];
        let moved = before.odom_from_vehicle.inv_mul(&after.odom_from_vehicle);
        let frames = (after.t_ns - before.t_ns) / FRAME_NS;
        let (metres, turn) = (moved.translation.vector.norm(), moved.rotation.angle());
        if metres > LARGEST_STEP * frames as f64 || turn > LARGEST_TURN * frames as f64 {
            let [from, to] = [before, after].map(|pose| pose.t_ns / FRAME_NS);
            let degrees = turn.to_degrees();
            warnings.push(format!(
                "the pose jumps by {metres:.1} m and {degrees:.0} degrees between the frames {from} and {to}: tracking \
                 across them is not to be trusted"
            ));
        }
    }
}
