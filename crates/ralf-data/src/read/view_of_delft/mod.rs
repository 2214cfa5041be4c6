//! View-of-Delft as published: KITTI's layout, once for the radar and once for the LiDAR.
//!
//! - All frames of `radar/training` are one sequence, `training`. The data set gives no timestamps; frames are numbered
//!   and were taken at 10 Hz, so frame n is at n x 100 ms, and a gap in the numbers is a gap in time. LiDAR points are
//!   already moved to the camera's time.
//! - One radar `radar`, one LiDAR `lidar`, one camera `camera`. LiDAR or image files that a frame lacks are left out of
//!   that sensor's timeline, with a warning. Image and pose are the same in both folders; the radar's are read.
//! - Every frame has a calibration file per sensor. The first frame's holds for all; frames that say otherwise are
//!   warned of.
//! - The vehicle frame is not given. Here it has the LiDAR's axes and its origin on the ground below the rear axle,
//!   1.12 m behind and 1.49 m below the LiDAR.
//! - Poses come from `odomToCamera`, which in spite of its name maps the camera's frame to odom:
//!   `odom_from_vehicle = odom_from_camera * camera_from_lidar * lidar_from_vehicle`. A frame without one is an error,
//!   for without it its neighbours in time would be moved wrongly.

mod calibration;
mod raw;
mod source;

use crate::error::DataError;
use crate::read::Recording;
use std::path::Path;

/// The format's name.
pub(crate) const NAME: &str = "view-of-delft";

/// Opens the data set at the folder that holds `radar/training` and `lidar/training`.
///
/// Errors: no frames, file names that are no numbers, calibrations or poses that are missing or no rigid transforms.
pub(crate) fn open(path: &Path) -> Result<Recording, DataError> {
    Ok(Recording::new(path, NAME, vec![Box::new(source::training(path)?)]))
}

/// Whether a folder looks like View-of-Delft.
pub(crate) fn recognises(path: &Path) -> bool {
    ["radar/training/velodyne", "radar/training/calib"].iter().all(|folder| path.join(folder).is_dir())
}

#[cfg(test)]
mod tests;
