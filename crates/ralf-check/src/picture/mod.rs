//! Whether edges of images lie where the LiDAR sees things end.

mod depth_edges;
mod edge_map;
mod look;

pub(crate) use depth_edges::{DepthEdge, depth_edges};
pub(crate) use look::{CameraLook, FEWEST_IMAGES, Moment, OddSize, Pictures, read};
