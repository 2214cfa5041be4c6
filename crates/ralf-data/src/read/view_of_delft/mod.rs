//! View-of-Delft as published: KITTI's layout, once for the radar and once for the LiDAR.
//!
//! - Each published clip of which `radar/training` has frames is a sequence, `delft_1` to `delft_27`: every drive has
//!   an odom frame of its own, and its neighbours in number are elsewhere. Frames of one clip alone are the sequence
//!   `training`, and so are those that no clip has.
//! - The data set gives no timestamps; frames are numbered and were taken at 10 Hz, so frame n is at n x 100 ms, and a
//!   gap in the numbers is a gap in time. LiDAR points are already moved to the camera's time.
//! - One radar `radar`, one LiDAR `lidar`, one camera `camera`. LiDAR or image files that a frame lacks are left out of
//!   that sensor's timeline, with a warning. Images and poses are the same in both folders; the radar's are read, and
//!   the LiDAR's where links to these didn't survive copying.
//! - Every frame has a calibration file per sensor. The first frame's holds for all; frames that say otherwise are
//!   warned of.
//! - The vehicle frame is not given. Here it has the LiDAR's axes and its origin on the ground below the rear axle,
//!   1.12 m behind and 1.49 m below the LiDAR.
//! - Poses come from `odomToCamera`, which in spite of its name maps the camera's frame to odom:
//!   `odom_from_vehicle = odom_from_camera * camera_from_lidar * lidar_from_vehicle`. Where a frame has none (00544,
//!   01312), the motion of the frames around tells where it was, with a warning.

mod calibration;
mod clips;
mod motion;
mod raw;
mod source;

use crate::error::DataError;
use crate::read::Recording;
use crate::read::opened::Opened;
use clips::clips;
use source::Layout;
use std::path::Path;

/// The format's name.
pub(crate) const NAME: &str = "view-of-delft";

/// Opens the data set at the folder that holds `radar/training` and `lidar/training`; where names are given, those
/// clips.
///
/// Errors: no frames, file names that are no numbers. Of a clip that is named, or if all are such: calibrations that
/// are missing or no rigid transforms, poses that are none, not one pose.
pub(crate) fn open(path: &Path, names: &[String]) -> Result<Recording, DataError> {
    let mut layout = Layout::of(path);
    let clips = clips(layout.frames()?);
    let opened = Opened::of(clips, names, |name, frames| layout.sequence(name, &frames))?;
    Ok(opened.recording(path, NAME, Vec::new()))
}

/// Whether a folder looks like View-of-Delft.
pub(crate) fn recognises(path: &Path) -> bool {
    ["radar/training/velodyne", "radar/training/calib"].iter().all(|folder| path.join(folder).is_dir())
}

#[cfg(test)]
mod tests;
