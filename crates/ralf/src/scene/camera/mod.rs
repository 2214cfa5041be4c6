//! The cameras' images around a moment, and the metric depth of what they show.
//!
//! What a depth network gave for a [`StraightView`](crate::sensors::StraightView) becomes metric in [`calibrate()`]:
//! LiDAR points are projected into the view ([`project_points`]), those that the camera cannot see leave, the rest
//! scale the relative depth around them, a monitor judges the outcome ([`ViewReport`]), and the calibrated pixels
//! return to the vehicle frame as [`CameraPoint`]s.

mod calibrate;
mod depth;
mod greenness;
mod grid;
mod lattice;
mod moment;
mod monitor;
mod projection;
mod scaling;
mod segmented;

pub use calibrate::{CalibratedView, Calibration, CameraPoint, calibrate};
pub use greenness::Greenness;
pub use lattice::DepthLattice;
pub use moment::{CalibratedImage, ImageId, ImageView, ImageWithDepth, Seen};
pub use monitor::{Failure, ViewReport, ViewState, luminance};
pub use projection::project_points;
pub use scaling::median;
pub use segmented::{ClassPixel, SegmentedImage, SegmentedStraightView, SegmentedView};
