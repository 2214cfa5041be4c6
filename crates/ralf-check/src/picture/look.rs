//! Which images are looked at, and how well a LiDAR's edges lie on theirs.

use super::DepthEdge;
use super::edge_map::EdgeMap;
use ralf::sensors::{Camera, Source};
use ralf::space::Transform;

/// Images of a camera that are looked at, and how few tell nothing: those are not read.
const IMAGES: usize = 12;
pub(crate) const FEWEST_IMAGES: usize = 6;
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

/// A LiDAR's scan whose edges are known.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Moment {
    pub(crate) lidar: usize,
    pub(crate) t_ns: i64,
}

/// Reads images beside the LiDAR's scans, evenly spread; those that can't be read are left out.
pub(crate) fn read(source: &dyn Source, moments: &[Moment]) -> Vec<CameraLook> {
    let sequence = source.sequence();
    let mut looks = Vec::new();
    for (camera, times) in sequence.times.cameras.iter().enumerate() {
        let mut beside: Vec<(usize, Moment)> = Vec::new();
        for moment in moments {
            let distance = |image: &usize| times[*image].abs_diff(moment.t_ns);
            let image = (0..times.len()).min_by_key(distance).filter(|i| distance(i) <= TOGETHER_NS);
            beside.extend(image.map(|image| (image, *moment)));
        }
        if beside.len() < FEWEST_IMAGES {
            continue;
        }
        let step = beside.len().div_ceil(IMAGES).max(1);
        for (image, moment) in beside.into_iter().step_by(step) {
            let own = &sequence.rig.cameras[camera];
            let read = source.image(camera, image).ok();
            if let Some(edges) = read.and_then(|image| EdgeMap::new(own, &image)) {
                let Moment { lidar, t_ns: lidar_ns } = moment;
                looks.push(CameraLook { camera, t_ns: times[image], lidar_ns, lidar, edges });
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
        let limit = camera.intrinsics.limit();
        let (mut sum, mut count) = (0.0, 0_usize);
        for edge in edges {
            let pixel = camera.intrinsics.project_within(&(camera_from_edges * edge.place), limit);
            if let Some(nearness) = pixel.and_then(|pixel| self.edges.at(pixel, edge.is_top)) {
                sum += nearness;
                count += 1;
            }
        }
        (count >= FEWEST).then(|| sum / count as f64)
    }
}
