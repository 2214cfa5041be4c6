//! What surrounds one radar scan: its detections with their uncertainty, the ground, the LiDAR scans and images nearest
//! in time, the neighbouring radar scans, and the one distance in which all of them are compared.

mod association;
mod camera;
mod cells;
mod doppler;
mod farthest;
mod floor;
mod frame;
mod ground;
mod lidar;
mod lidar_cloud;
mod lidar_search;
mod lidar_window;
mod located;
mod mismatch;
mod mover;
mod neighbouring;
mod neighbouring_detections;
mod ordered;
mod rays;
mod sight;
mod standing;
mod static_map;
mod strength;
mod terrain;
mod window;

pub use association::{Association, index_of};
pub use camera::{
    CalibratedImage, CalibratedView, Calibration, CameraPoint, ClassPixel, DepthLattice, Failure, Greenness,
    ImageId, ImageView, ImageWithDepth, Seen, SegmentedImage, SegmentedStraightView, SegmentedView,
    ViewReport, ViewState, calibrate, luminance, median, project_points,
};
pub use doppler::{Doppler, own_motion, radar_velocity};
pub use floor::LocalGround;
pub use frame::{Frame, NotRead, SensorKind, Unreadable};
pub use ground::{Ground, GroundSurface, Plane};
pub use lidar::{LidarRay, LidarSnapshot, LidarSweep, LidarView};
pub use lidar_cloud::LidarCloud;
pub use lidar_search::LidarSearch;
pub use lidar_window::{LidarWindow, LidarWindowView};
pub use located::{Detection, LocatedScan};
pub use mismatch::{Reference, Spread, mismatch, plausibility, reach_of_cap};
pub use mover::{ACROSS_PER_ALONG, Mover, rate_sigma};
pub use neighbouring::{NeighbouringScan, ScanStep};
pub use neighbouring_detections::NeighbouringDetections;
pub use ordered::Ordered;
pub use rays::{Cone, RayTable, TableRay, direction_of};
pub use sight::{Reach, Sight, Sights};
pub use static_map::{Column, ColumnGrid, StaticMap};
pub use strength::Strength;
pub use terrain::{Terrain, Texture};
pub use window::FrameWindow;
