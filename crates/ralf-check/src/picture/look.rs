//! Which images are looked at, and how well a LiDAR's edges lie on theirs.

use super::DepthEdge;
use super::edge_map::EdgeMap;
use crate::sample::{LidarLook, nearest};
use ralf::sensors::{Camera, Source};
use ralf::space::Transform;

/// Images of a camera that are looked at.
const IMAGES: usize = 12;
/// An image belongs to a LiDAR's scan within this, ns.
const TOGETHER_NS: u64 = 60_000_000;
/// Fewer edges in an image say nothing.
const FEWEST: usize = 25;

/// An image beside a LiDAR's scan.
#[derive(Debug, Clone)]
pub(crate) struct CameraLook {
    pub(crate) camera: usize,
    pub(crate) t_ns: i64,
    /// Time of the LiDAR's scan.
    pub(crate) lidar_ns: i64,
    pub(crate) lidar: usize,
    edges: EdgeMap,
}

/// Reads images beside the LiDAR's scans, evenly spread; those that can't be read are left out.
pub(crate) fn read(source: &dyn Source, lidars: &[LidarLook]) -> Vec<CameraLook> {
    let sequence = source.sequence();
    let mut looks = Vec::new();
    for (camera, times) in sequence.times.cameras.iter().enumerate() {
        let mut beside: Vec<(usize, &LidarLook)> = Vec::new();
        for lidar in lidars.iter().filter(|look| look.lidar == 0 && look.edges.len() >= FEWEST) {
            let image = nearest(times, lidar.t_ns).filter(|i| times[*i].abs_diff(lidar.t_ns) <= TOGETHER_NS);
            beside.extend(image.map(|image| (image, lidar)));
        }
        let step = beside.len().div_ceil(IMAGES).max(1);
        for (image, lidar) in beside.into_iter().step_by(step) {
            let own = &sequence.rig.cameras[camera];
            let read = source.image(camera, image).ok();
            if let Some(edges) = read.and_then(|image| EdgeMap::new(own, &image)) {
                let (t_ns, lidar_ns, lidar) = (times[image], lidar.t_ns, lidar.lidar);
                looks.push(CameraLook { camera, t_ns, lidar_ns, lidar, edges });
            }
        }
    }
    looks
}

impl CameraLook {
    /// Mean nearness of the LiDAR's edges to the image's, where the camera's optical frame has them at a pose; `None`
    /// where too few lie in the image.
    pub(crate) fn score(
        &self,
        camera: &Camera,
        camera_from_edges: &Transform,
        edges: &[DepthEdge],
    ) -> Option<f64> {
        let (mut sum, mut count) = (0.0, 0_usize);
        for edge in edges {
            let pixel = camera.intrinsics.project(&(camera_from_edges * edge.place));
            if let Some(nearness) = pixel.and_then(|pixel| self.edges.at(pixel, edge.is_top)) {
                sum += nearness;
                count += 1;
            }
        }
        (count >= FEWEST).then(|| sum / count as f64)
    }
}
