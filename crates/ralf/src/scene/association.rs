//! The association of a detection with its nearest reference points (paper, algorithm 1; docs/method.md, section 3).

use super::located::Detection;
use super::mismatch::{Reference, mismatch};
use crate::sensors::Elevation;
use crate::space::{Neighbor, NeighborIndex, Point, Vector};

/// Where a point is searched: in the horizontal plane for a radar without elevation.
fn searched_at(p: &Point, elevation: Elevation) -> [f32; 3] {
    let z = if elevation == Elevation::None { 0.0 } else { p.z };
    [p.x as f32, p.y as f32, z as f32]
}

/// A difference as it is measured: horizontal for a radar without elevation.
fn level(h: Vector, elevation: Elevation) -> Vector {
    if elevation == Elevation::None { Vector::new(h.x, h.y, 0.0) } else { h }
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
    /// What the last [`Self::nearest_by`] looked at.
    beside: Vec<u32>,
}

impl<'a> Association<'a> {
    /// An association with so many neighbours, for a radar that measures elevation or not; in the second case the index
    /// must be horizontal.
    pub fn new(index: &'a NeighborIndex, elevation: Elevation, neighbours: usize) -> Self {
        let found = Vec::with_capacity(neighbours.min(index.len()));
        Self { index, elevation, neighbours, reach: f32::INFINITY, found, beside: Vec::new() }
    }

    /// From now on a cloud all of whose points are farther than this, m, may be taken for empty.
    pub fn set_reach(&mut self, reach: f64) {
        self.reach = reach as f32;
    }

    /// The nearest points, nearest first; none where the cloud is empty. `query` lies in the frame of the index.
    pub fn nearest(&mut self, query: &Point) -> &[Neighbor] {
        let query = searched_at(query, self.elevation);
        self.index.nearest_if_within(query, self.neighbours, self.reach, &mut self.found);
        &self.found
    }

    /// The points nearest by another measure, nearest first, of equally near ones the smaller identity first: among
    /// those within `reach`, m, of the query in the horizontal plane, and so perhaps fewer than there may be
    /// neighbours. `offset` leads from a point to where it is wanted, m; `None` where the point is out of the question.
    pub fn nearest_by(
        &mut self,
        query: &Point,
        reach: f64,
        offset: impl Fn(u32) -> Option<Vector>,
    ) -> &[Neighbor] {
        let place = [query.x as f32, query.y as f32];
        self.index.beside(place, reach as f32, &mut self.beside);
        self.found.clear();
        for &id in &self.beside {
            let Some(offset) = offset(id) else { continue };
            let distance_squared = level(offset, self.elevation).norm_squared() as f32;
            self.found.push(Neighbor { id, distance_squared });
        }
        let order = |a: &Neighbor, b: &Neighbor| {
            a.distance_squared.total_cmp(&b.distance_squared).then(a.id.cmp(&b.id))
        };
        if self.found.len() > self.neighbours {
            self.found.select_nth_unstable_by(self.neighbours - 1, order);
            self.found.truncate(self.neighbours);
        }
        self.found.sort_unstable_by(order);
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
        self.mean_over_found(|id| self.mismatch(detection, &reference(id)))
    }

    /// The mean over the points of the last association; `None` where it found none.
    pub fn mean_over_found(&self, mismatch: impl Fn(u32) -> f64) -> Option<f64> {
        let sum: f64 = self.found.iter().map(|neighbor| mismatch(neighbor.id)).sum();
        (!self.found.is_empty()).then(|| sum / self.found.len() as f64)
    }

    /// The mismatch of a detection with a point in the same frame, as the radar measures: in the horizontal plane where
    /// it measures no elevation.
    pub fn mismatch(&self, detection: &Detection, reference: &Reference) -> f64 {
        let h = level(detection.position - reference.position, self.elevation);
        mismatch(&h, &detection.spread(), &reference.spread)
    }

    /// The points of the last association.
    pub fn found(&self) -> &[Neighbor] {
        &self.found
    }
}
