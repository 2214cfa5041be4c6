//! The association of a detection with its nearest reference points (paper, algorithm 1; docs/method.md, section 3).

use super::located::Detection;
use super::mismatch::{Reference, mismatch};
use crate::sensors::Elevation;
use crate::space::{Neighbor, NeighborIndex, Point};

/// Where a point is searched: in the horizontal plane for a radar without elevation.
fn searched_at(p: &Point, elevation: Elevation) -> [f32; 3] {
    let z = if elevation == Elevation::None { 0.0 } else { p.z };
    [p.x as f32, p.y as f32, z as f32]
}

/// An index over a cloud for detections of a radar that measures elevation or not; a point's index in the cloud is its
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
    /// An association with so many neighbours, for a radar that measures elevation or not; in the second case the index
    /// must be horizontal.
    pub fn new(index: &'a NeighborIndex, elevation: Elevation, neighbours: usize) -> Self {
        let found = Vec::with_capacity(neighbours.min(index.len()));
        Self { index, elevation, neighbours, reach: f32::INFINITY, found }
    }

    /// From now on a cloud all of whose points are farther than this, m, may be taken for empty.
    pub fn set_reach(&mut self, reach: f64) {
        self.reach = reach as f32;
    }

    /// The nearest points, nearest first; none where the cloud is empty. `query` lies in the frame of the index.
    pub fn nearest(&mut self, query: &Point) -> &[Neighbor] {
        let query = searched_at(query, self.elevation);
        self.index.nearest_within(query, self.neighbours, self.reach, &mut self.found);
        &self.found
    }

    /// The mean mismatch with the nearest points; `None` where the cloud is empty.
    ///
    /// `query` is the detection in the frame of the index; `reference` gives a point in the detection's frame.
    pub fn mean_mismatch(
        &mut self,
        detection: &Detection,
        query: &Point,
        reference: impl Fn(u32) -> Reference,
    ) -> Option<f64> {
        self.nearest(query);
        if self.found.is_empty() {
            return None;
        }
        let spread = detection.spread();
        let mut sum = 0.0;
        for neighbor in &self.found {
            let reference = reference(neighbor.id);
            let mut h = detection.position - reference.position;
            if self.elevation == Elevation::None {
                h.z = 0.0;
            }
            sum += mismatch(&h, &spread, &reference.spread);
        }
        Some(sum / self.found.len() as f64)
    }

    /// The points of the last association.
    pub fn found(&self) -> &[Neighbor] {
        &self.found
    }
}
