//! Cameras: how they see, and the depth of what they see (METHOD 5).
//!
//! Each [`Camera`] is cut into [`StraightView`]s, and an [`UndistortMap`] straightens its images for a depth network. What the
//! network gave becomes metric in [`calibrate()`]: LiDAR points are projected into the view ([`project_points`]), those
//! that the camera cannot see leave, the rest scale the relative depth around them, a monitor judges the outcome
//! ([`ViewReport`]), and the calibrated pixels return to the vehicle frame as [`CameraPoint`]s.

mod calibrate;
mod depth;
mod grid;
mod image;
pub mod intrinsics;
mod matching;
mod moment;
mod monitor;
mod projection;
mod scaling;
mod undistort;
mod view;

pub use calibrate::{CalibratedView, CameraPoint, Surroundings, calibrate};
pub use image::{CameraImage, DepthImage, DepthOutput};
pub use intrinsics::Intrinsics;
pub use matching::{CameraMatch, match_detections};
pub use moment::{Calibration, ImageMoment, ImageView, ImageWithDepth};
pub use monitor::{Failure, ViewReport, ViewState, luminance};
pub use projection::project_points;
pub use scaling::median;
pub use undistort::UndistortMap;
pub use view::{StraightView, View, ViewPoint};

use crate::geometry::Transform;

/// A camera: its mounting, its lens, and the straight views that are cut out of its image.
#[derive(Debug, Clone)]
pub struct Camera {
    /// Unique in its rig.
    pub name: String,
    /// Extrinsics, of the optical frame (x right, y down, z forward).
    pub vehicle_from_camera: Transform,
    /// Image width, px.
    pub width: usize,
    /// Image height, px.
    pub height: usize,
    /// How directions become pixels.
    pub intrinsics: Intrinsics,
    /// The straight views, as configured. Empty: one view along the axis, of the image's size.
    pub views: Vec<View>,
}
