//! The LiDAR scans of the seconds around a moment.

use super::ground::GroundSurface;
use super::lidar::LidarView;
use super::static_map::StaticMap;
use super::terrain::Terrain;
use crate::space::{Point, Transform};
use nalgebra::{Isometry3, Point3};
use std::sync::{Arc, OnceLock};

/// LiDAR scans of the seconds around a moment, shared by the radar scans that are nearest to it, with what is worked
/// out of them together.
#[derive(Debug)]
pub struct LidarWindow {
    /// The moment in the middle, ns.
    pub t_ns: i64,
    /// The scans, in time order, each with the way to the vehicle frame at the middle.
    pub views: Vec<LidarView>,
    ground: OnceLock<Option<GroundSurface>>,
    map: OnceLock<StaticMap>,
    terrain: OnceLock<Terrain>,
}

/// A window of LiDAR scans, seen from a radar scan.
#[derive(Debug, Clone)]
pub struct LidarWindowView {
    /// The scans.
    pub window: Arc<LidarWindow>,
    /// From the window's vehicle frame to that at the radar scan's time.
    pub vehicle_from_window: Transform,
}

impl LidarWindow {
    /// A window of these scans, in the vehicle frame at a time.
    pub fn new(t_ns: i64, views: Vec<LidarView>) -> Self {
        Self { t_ns, views, ground: OnceLock::new(), map: OnceLock::new(), terrain: OnceLock::new() }
    }

    /// The ground surface of all scans together, in the vehicle frame at the middle; `None` where none was seen.
    pub fn ground(&self) -> Option<&GroundSurface> {
        self.ground.get_or_init(|| GroundSurface::fit(&self.lowest_points())).as_ref()
    }

    /// What stands still, in the vehicle frame at the middle.
    pub fn map(&self) -> &StaticMap {
        self.map.get_or_init(|| StaticMap::new(self.t_ns, &self.views, self.ground()))
    }

    /// What the ground is like, in the vehicle frame at the middle.
    pub fn terrain(&self) -> &Terrain {
        let scans = self.views.iter().map(|view| (view.vehicle_from_moment, view.moment.patches()));
        self.terrain.get_or_init(|| Terrain::new(scans))
    }

    fn lowest_points(&self) -> Vec<[f32; 3]> {
        let mut points = Vec::new();
        for view in &self.views {
            let window_from_moment: Isometry3<f32> = view.vehicle_from_moment.cast();
            let moved = |point: &[f32; 3]| <[f32; 3]>::from(window_from_moment * Point3::from(*point));
            points.extend(view.moment.lowest_points().iter().map(moved));
        }
        points
    }
}

impl LidarWindowView {
    /// The scans, each with the way to the vehicle frame at the radar scan's time.
    pub fn views(&self) -> impl Iterator<Item = LidarView> {
        self.window.views.iter().map(|view| LidarView {
            moment: view.moment.clone(),
            vehicle_from_moment: self.vehicle_from_window * view.vehicle_from_moment,
        })
    }

    /// A point of the vehicle frame at the radar scan's time, in the window's.
    pub fn to_window(&self, p: &Point) -> Point {
        self.vehicle_from_window.inverse_transform_point(p)
    }
}
