//! The LiDAR scans of the seconds around a moment.

use super::lidar::LidarView;
use crate::space::Transform;
use std::sync::Arc;

/// LiDAR scans of the seconds around a moment, shared by the radar scans that are nearest to it.
#[derive(Debug)]
pub struct LidarWindow {
    /// The moment in the middle, ns.
    pub t_ns: i64,
    /// The scans, in time order, each with the way to the vehicle frame at the middle.
    pub views: Vec<LidarView>,
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
        Self { t_ns, views }
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
}
