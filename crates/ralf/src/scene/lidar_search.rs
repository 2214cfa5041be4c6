//! Searches the reference clouds of several LiDAR scans as if they were one.

use super::association::Association;
use super::lidar_cloud::LidarCloud;
use super::located::Detection;
use super::mover::Mover;
use crate::space::Neighbor;

/// The nearest points of several clouds together. Every scan keeps its own index, which the radar scans around share:
/// the `K` nearest of all are among the `K` nearest of each.
pub struct LidarSearch<'a> {
    clouds: &'a [LidarCloud<'a>],
    /// One per cloud.
    associations: Vec<Association<'a>>,
    neighbours: usize,
    /// Which cloud, and the point there.
    found: Vec<(usize, Neighbor)>,
}

impl<'a> LidarSearch<'a> {
    /// A search for so many points of clouds in the same vehicle frame, for the same radar.
    pub fn new(clouds: &'a [LidarCloud<'a>], neighbours: usize) -> Self {
        let associations = clouds.iter().map(|cloud| cloud.association(neighbours)).collect();
        Self { clouds, associations, neighbours, found: Vec::with_capacity(neighbours) }
    }

    /// How far something moves, at most, m, from where it is at a time to where it was when a point was measured.
    pub fn farthest_move(&self, mover: &Mover, t_ns: i64) -> f64 {
        let filled = self.clouds.iter().filter(|cloud| !cloud.is_empty());
        filled.map(|cloud| cloud.farthest_move(mover, t_ns)).fold(0.0, f64::max)
    }

    /// The mean mismatch of a detection with the nearest points of the first so many clouds. `None` where these are
    /// empty, and where every mismatch is above the cap, unless points carry classes.
    pub fn mean_mismatch(&mut self, detection: &Detection, clouds: usize, cap: f64) -> Option<f64> {
        let clouds = &self.clouds[..clouds.min(self.clouds.len())];
        let associations = &mut self.associations[..clouds.len()];
        // A point beyond the cap says nothing but its class.
        let with_classes = clouds.iter().any(LidarCloud::has_classes);
        for (cloud, association) in clouds.iter().zip(&mut *associations) {
            association.set_reach(if with_classes { f64::INFINITY } else { cloud.reach(detection, cap) });
            cloud.associate(association, detection);
        }
        // Where one cloud has something near, what is farther in another may still be among the nearest.
        if associations.iter().any(|association| !association.found().is_empty()) {
            let found_none = |(_, association): &(_, &mut Association)| association.found().is_empty();
            for (cloud, association) in clouds.iter().zip(associations).filter(found_none) {
                association.set_reach(f64::INFINITY);
                cloud.associate(association, detection);
            }
        }
        let clouds = clouds.len();
        self.keep_nearest(clouds);
        self.mean(|search, cloud, id| {
            search.associations[cloud].mismatch(detection, &search.clouds[cloud].reference(id))
        })
    }

    /// The mean mismatch of a detection that moves with the nearest points, each compared with where the detection was
    /// when the point was measured; `None` where the clouds are empty. `t_ns` is the time of the detection.
    pub fn mean_mismatch_of_mover(&mut self, mover: &Mover, t_ns: i64) -> Option<f64> {
        let filled = |(cloud, _): &(&LidarCloud, _)| !cloud.is_empty();
        for (cloud, association) in self.clouds.iter().zip(&mut self.associations).filter(filled) {
            association.set_reach(f64::INFINITY);
            cloud.associate_mover(association, mover, t_ns);
        }
        self.keep_nearest(self.clouds.len());
        self.mean(|search, cloud, id| {
            let (cloud, association) = (&search.clouds[cloud], &search.associations[cloud]);
            association.mismatch(&cloud.at_time_of(id, mover, t_ns), &cloud.reference(id))
        })
    }

    /// The SemanticKITTI ids of the points that were found last, nearest first; 0 where a point has none.
    pub fn classes(&self) -> impl Iterator<Item = u16> {
        self.found.iter().map(|(cloud, neighbor)| self.clouds[*cloud].class(neighbor.id))
    }

    /// Of what the first so many clouds found, the nearest; of equally near ones those of the earlier cloud.
    fn keep_nearest(&mut self, clouds: usize) {
        self.found.clear();
        for (cloud, association) in self.associations.iter().take(clouds).enumerate() {
            self.found.extend(association.found().iter().map(|neighbor| (cloud, *neighbor)));
        }
        // Stable, so that each cloud's order stays.
        self.found.sort_by(|(_, a), (_, b)| a.distance_squared.total_cmp(&b.distance_squared));
        self.found.truncate(self.neighbours);
    }

    fn mean(&self, mismatch: impl Fn(&Self, usize, u32) -> f64) -> Option<f64> {
        let sum: f64 = self.found.iter().map(|(cloud, neighbor)| mismatch(self, *cloud, neighbor.id)).sum();
        (!self.found.is_empty()).then(|| sum / self.found.len() as f64)
    }
}
