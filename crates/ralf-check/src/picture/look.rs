//! Which images are looked at, and how well a LiDAR's edges lie on theirs.

use super::depth_look::{DepthLook, depth_looks};
use super::edge_map::EdgeMap;
use super::{DepthEdge, Moment};
use crate::thinning::spread;
use ralf::sensors::{Camera, ImageSizeError, Source};
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

/// A camera none of whose images has the size that it is calibrated for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct OddSize {
    pub(crate) camera: usize,
    /// Width and height of its first image, px.
    pub(crate) size: [usize; 2],
}

/// What was seen of images.
#[derive(Debug, Clone, Default)]
pub(crate) struct Pictures {
    /// Of all cameras, in the order of the rig and of time.
    pub(crate) looks: Vec<CameraLook>,
    pub(crate) odd_sizes: Vec<OddSize>,
    /// Of the stored depth of the same images.
    pub(crate) depths: Vec<DepthLook>,
}

/// Reads images beside the LiDAR's scans, evenly spread. Left out are those that can't be read, and those of another
/// size than the calibration's: nothing tells where in them a point lies.
pub(crate) fn read(source: &dyn Source, moments: &[Moment]) -> Pictures {
    let sequence = source.sequence();
    let mut found = Pictures::default();
    for (camera, times) in sequence.times.cameras.iter().enumerate() {
        let own = &sequence.rig.cameras[camera];
        let (mut odd, mut fits) = (None, false);
        for (image, moment) in beside(times, moments) {
            let read = match source.image(camera, image) {
                Ok(read) if own.check_image(&read).is_ok() => read,
                Ok(read) => {
                    odd = odd.or(Some([read.width, read.height]));
                    continue;
                }
                Err(error) => {
                    odd = odd.or(error.downcast_ref::<ImageSizeError>().map(|size| size.found));
                    continue;
                }
            };
            fits = true;
            if let Some(edges) = EdgeMap::new(own, &read) {
                let (lidar, lidar_ns) = (moment.lidar, moment.t_ns);
                found.looks.push(CameraLook { camera, t_ns: times[image], lidar_ns, lidar, edges });
            }
            found.depths.extend(depth_looks(source, [camera, image], &moment));
        }
        found.odd_sizes.extend(odd.filter(|_| !fits).map(|size| OddSize { camera, size }));
    }
    found
}

/// The images that are looked at, each with the LiDAR's scan beside it; none where they are too few.
fn beside<'a>(times: &[i64], moments: &[Moment<'a>]) -> Vec<(usize, Moment<'a>)> {
    let nearest = |moment: &Moment<'a>| {
        let distance = |image: &usize| times[*image].abs_diff(moment.t_ns);
        let image = (0..times.len()).min_by_key(distance).filter(|i| distance(i) <= TOGETHER_NS);
        image.map(|image| (image, *moment))
    };
    let beside: Vec<_> = moments.iter().filter_map(nearest).collect();
    if beside.len() < FEWEST_IMAGES {
        return Vec::new();
    }
    spread(beside.len(), IMAGES).into_iter().map(|i| beside[i]).collect()
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
