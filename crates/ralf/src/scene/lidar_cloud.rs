//! The LiDAR's reference cloud: the points above the ground, as one radar is compared with them.

use super::association::Association;
use super::lidar::LidarView;
use super::located::Detection;
use super::mismatch::{Reference, reach_of_cap};
use super::mover::Mover;
use crate::sensors::{Elevation, Radar};
use crate::space::{NeighborIndex, Transform};
use std::borrow::Cow;

/// The LiDAR points above the ground, ready to be searched for detections of one radar. Identities are those of the
/// view's [`LidarSnapshot`](super::LidarSnapshot).
pub struct LidarCloud<'a> {
    view: &'a LidarView,
    /// One per sweep of the view.
    vehicle_from_lidars: Vec<Transform>,
    elevation: Elevation,
    index: Cow<'a, NeighborIndex>,
    index_from_vehicle: Transform,
}

impl<'a> LidarCloud<'a> {
    /// The cloud of a view for a radar. One that measures no elevation searches in the horizontal plane, among the
    /// points within its vertical field of view.
    pub fn new(view: &'a LidarView, radar: &Radar) -> Self {
        match radar.elevation {
            // Distances in space are the same in every frame, so the shared index is asked in its own. Horizontal ones
            // are not.
            Elevation::Measured => Self {
                index_from_vehicle: view.vehicle_from_moment.inverse(),
                elevation: Elevation::Measured,
                ..Self::horizontal(view, Cow::Borrowed(view.moment.index()))
            },
            Elevation::None => {
                let index = view.moment.horizontal_index(radar, &view.vehicle_from_moment);
                Self::horizontal(view, Cow::Owned(index))
            }
        }
    }

    /// The cloud for a radar that measures no elevation, whose horizontal index is known.
    pub(super) fn horizontal(view: &'a LidarView, index: Cow<'a, NeighborIndex>) -> Self {
        let vehicle_from_lidars = view.moment.vehicle_from_lidars(&view.vehicle_from_moment);
        let index_from_vehicle = Transform::identity();
        Self { view, vehicle_from_lidars, elevation: Elevation::None, index, index_from_vehicle }
    }

    /// Whether there is nothing to compare with.
    pub fn is_empty(&self) -> bool {
        self.index.is_empty()
    }

    /// Farther from a detection than this, m, every point's mismatch is above the cap.
    pub fn reach(&self, detection: &Detection, cap: f64) -> f64 {
        let sigma_range = self.view.moment.max_sigma_range();
        reach_of_cap(cap, detection.total_variance() + sigma_range * sigma_range)
    }

    /// An association with this cloud.
    pub fn association(&self, neighbours: usize) -> Association<'_> {
        Association::new(&self.index, self.elevation, neighbours)
    }

    /// Whether points carry classes.
    pub fn has_classes(&self) -> bool {
        self.view.moment.has_classes()
    }

    /// The SemanticKITTI id of a point, 0 where it has none.
    pub fn class(&self, id: u32) -> u16 {
        self.view.moment.class(id)
    }

    /// How far something moves, at most, m, from where it is at a time to where it was when a point was measured.
    pub fn farthest_move(&self, mover: &Mover, t_ns: i64) -> f64 {
        let span = self.view.moment.span_after(t_ns);
        mover.rate().abs() * span.start.abs().max(span.end.abs())
    }

    /// Associates a detection that moves with the points that are nearest to where the detection was when the point was
    /// measured; with none where the cloud is empty. `t_ns` is the time of the detection.
    ///
    /// That is exact: a point lies as far from the detection at the middle of the LiDAR's time as from the detection at
    /// the point's own time, to within the way that lies between. So all points that can be among the nearest are found
    /// around the middle, once some points bound the distance.
    pub(super) fn associate_mover(&self, association: &mut Association, mover: &Mover, t_ns: i64) {
        const ROUNDING: f64 = 1e-3;
        let span = self.view.moment.span_after(t_ns);
        let middle = mover.along_ray((span.start + span.end) / 2.0).position;
        let half_way = mover.rate().abs() * (span.end - span.start) / 2.0;
        let offset = |id| self.at_time_of(id, mover, t_ns).position - self.reference(id).position;

        let query = self.index_from_vehicle * middle;
        let some = association.nearest(&query).iter().map(|neighbor| offset(neighbor.id).norm());
        let bound = some.fold(0.0, f64::max);
        association.nearest_by(&query, bound + half_way + ROUNDING, |id| Some(offset(id)));
    }

    /// Where something that moves is when a point is measured. `t_ns` is the time of the detection.
    pub(super) fn at_time_of(&self, id: u32, mover: &Mover, t_ns: i64) -> Detection {
        mover.after(self.view.moment.seconds_after(t_ns, id))
    }

    /// Associates a detection with its nearest points; with none where the cloud is empty.
    pub(super) fn associate(&self, association: &mut Association, detection: &Detection) {
        association.nearest(&(self.index_from_vehicle * detection.position));
    }

    /// The points nearest to a detection, in the vehicle frame at hand, nearest first; none where the cloud is empty.
    pub fn nearest(&self, association: &mut Association, detection: &Detection) -> Vec<Reference> {
        self.associate(association, detection);
        association.found().iter().map(|neighbor| self.reference(neighbor.id)).collect()
    }

    pub(super) fn reference(&self, id: u32) -> Reference {
        self.view.moment.reference(id, &self.vehicle_from_lidars)
    }
}
