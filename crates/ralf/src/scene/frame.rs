//! Everything the method needs for one radar scan.

use super::camera::ImageView;
use super::detections::Detections;
use super::floor::LocalGround;
use super::lidar::LidarView;
use super::neighbouring::TrackingStep;
use crate::sensors::{Radar, Rig};
use std::sync::Arc;

/// One radar scan with what the other sensors and the neighbouring scans saw.
#[derive(Debug, Clone)]
pub struct Frame<'a> {
    /// All sensors.
    pub rig: &'a Rig,
    /// The radar that made the scan.
    pub radar: &'a Radar,
    /// The scan, in the vehicle frame at its time: the frame in which everything is compared.
    pub detections: Arc<Detections>,
    /// The LiDAR scans nearest in time; `None` where there is none within the tolerance.
    pub lidar: Option<LidarView>,
    /// The ground in the vehicle frame at the scan's time; `None` where there is none.
    pub ground: Option<LocalGround>,
    /// The cameras' images nearest in time for which there is depth.
    pub images: Vec<ImageView>,
    /// The neighbouring radar scans, in time order.
    pub steps: Vec<TrackingStep>,
    /// Ego-compensated range rates of the detections, m/s, where `tracking.dynamic` wants them and the radar measures
    /// them.
    pub doppler: Option<Vec<f64>>,
    /// LiDAR scans that belong to it and can't be read: the scan is labelled without them.
    pub unreadable: Vec<Unreadable>,
}

/// A measurement that can't be read.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Unreadable {
    /// The sensor's name.
    pub sensor: String,
    /// Its place in the sensor's timeline, from 0.
    pub index: usize,
    /// File, place, expected, found.
    pub reason: String,
}

impl Frame<'_> {
    /// The steps of a batch of `n_b` scans before and after, of which the frame may hold more.
    pub fn steps_within(&self, n_b: usize) -> &[TrackingStep] {
        let begin = self.steps.partition_point(|step| step.j < 0 && step.j.unsigned_abs() > n_b);
        let end = self.steps.partition_point(|step| step.j < 0 || step.j.unsigned_abs() <= n_b);
        &self.steps[begin..end]
    }
}
