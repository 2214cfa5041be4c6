//! Whether edges of images lie where the LiDAR sees things end, and stored depth grows with the LiDAR's.

mod depth_edges;
mod depth_look;
mod edge_map;
mod look;

pub(crate) use depth_edges::{DepthEdge, depth_edges};
pub(crate) use depth_look::{Agreement, DepthLook};
pub(crate) use look::{CameraLook, FEWEST_IMAGES, OddSize, Pictures, read};

use ralf::space::Point;

/// A LiDAR's scan beside which images are looked at.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment<'a> {
    pub(crate) lidar: usize,
    pub(crate) t_ns: i64,
    /// Some of its points, vehicle frame as recorded, m.
    pub(crate) points: &'a [Point],
}
