//! What surrounds one radar scan: its detections with their uncertainty, the ground, the LiDAR scans and images nearest
//! in time, the neighbouring radar scans, and the one distance in which all of them are compared.

mod association;
mod camera;
mod detections;
mod doppler;
mod floor;
mod frame;
mod ground;
mod lidar;
mod mismatch;
mod neighbouring;
mod window;

pub use association::{Association, index_of};
pub use camera::{
    CalibratedView, Calibration, CameraPoint, Failure, ImageMoment, ImageView, ImageWithDepth, Seen,
    Surroundings, ViewReport, ViewState, calibrate, luminance, median, project_points,
};
pub use detections::{Detections, Located};
pub use doppler::compensated_doppler;
pub use floor::LocalGround;
pub use frame::{Frame, Unreadable};
pub use ground::{Ground, Plane};
pub use lidar::{LidarMoment, LidarView};
pub use mismatch::{Reference, Spread, distance_per_mismatch, mismatch, plausibility};
pub use neighbouring::TrackingStep;
pub use window::FrameWindow;
