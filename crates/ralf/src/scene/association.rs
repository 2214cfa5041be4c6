//! The association of a detection with its nearest reference points (docs/method.md, section 3).

use super::located::Detection;
use super::mismatch::{Reference, mismatch};
use crate::sensors::Elevation;
use crate::space::{Neighbor, NeighborIndex, Point};

/// Where a point is searched: of a radar without elevation in the horizontal plane.
fn searched_at(p: &Point, elevation: Elevation) -> [f32; 3] {
    let z = if elevation == Elevation::None { 0.0 } else { p.z };
    [p.x as f32, p.y as f32, z as f32]
}

/// An index over a cloud for detections of a radar that measures elevation or not; a point's place in it is its
/// identity.
pub fn index_of<'a>(points: impl Iterator<Item = &'a Point>, elevation: Elevation) -> NeighborIndex {
    let places: Vec<_> = points.map(|p| searched_at(p, elevation)).collect();
    let ids: Vec<u32> = (0..places.len() as u32).collect();
    NeighborIndex::new(&places, &ids)
}

/// Associates detections of one radar with the points of one cloud.
pub struct Association<'a> {
    index: &'a NeighborIndex,
    elevation: Elevation,
    neighbours: usize,
    reach: f32,
    found: Vec<Neighbor>,
}

impl<'a> Association<'a> {
    /// For detections of a radar that measures elevation or not; in the second case the index must be horizontal.
    pub fn new(index: &'a NeighborIndex, elevation: Elevation, neighbours: usize) -> Self {
        Self { index, elevation, neighbours, reach: f32::INFINITY, found: Vec::with_capacity(neighbours) }
    }

    /// From now on a cloud all of whose points are farther than this, m, may be taken for empty.
    pub fn set_reach(&mut self, reach: f64) {
        self.reach = reach as f32;
    }

    /// The mean mismatch with the nearest points; `None` where the cloud is empty.
    ///
    /// `place` is where the detection lies in the frame of the index; `reference` gives a point in the detection's
    /// frame.
    pub fn mean_mismatch(
        &mut self,
        detection: &Detection,
        place: &Point,
        reference: impl Fn(u32) -> Reference,
    ) -> Option<f64> {
        let query = searched_at(place, self.elevation);
        self.index.nearest_within(query, self.neighbours, self.reach, &mut self.found);
        if self.found.is_empty() {
            return None;
        }
        let spread = detection.spread();
        let sum: f64 = self
            .found
            .iter()
            .map(|neighbor| {
                let reference = reference(neighbor.id);
                let mut h = detection.position - reference.position;
                if self.elevation == Elevation::None {
                    h.z = 0.0;
                }
                mismatch(&h, &spread, &reference.spread)
            })
            .sum();
        Some(sum / self.found.len() as f64)
    }

    /// The points of the last association.
    pub fn found(&self) -> &[Neighbor] {
        &self.found
    }
}
