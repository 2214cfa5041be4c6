//! The sensors of a vehicle, how they are mounted, what they deliver, and where that comes from.

mod amplitude;
mod bounds;
mod camera;
mod image;
mod intrinsics;
mod measurement;
mod memory;
mod rig;
mod rolling;
mod source;
mod undistort;
mod view;

pub use amplitude::{AmplitudeField, AmplitudeKind};
pub use bounds::{FARTHEST, MOST_PIXELS, check_mounting};
pub use camera::Camera;
pub use image::{CameraImage, ClassImage, DepthImage, DepthOutput, ImageSizeError};
pub use intrinsics::Intrinsics;
pub use measurement::{LONGEST_AFTER, LidarScan, RadarScan, check_fields, is_return};
pub use memory::{MemoryError, MemorySource, TimedImage};
pub use rig::{COORDINATE_FIELDS, Elevation, Lidar, Radar, Reliability, Rig};
pub use source::{KNOWN_NS, Sequence, Source, SourceError, Timelines};
pub use undistort::UndistortMap;
pub use view::{StraightView, View, ViewPoint};
