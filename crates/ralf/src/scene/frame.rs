//! Everything that is known around one radar scan.

use super::camera::ImageView;
use super::doppler::{Doppler, radar_velocity};
use super::floor::LocalGround;
use super::lidar::LidarView;
use super::located::{Detection, LocatedScan};
use super::mover::Mover;
use super::neighbouring::ScanStep;
use crate::config::GroundConfig;
use crate::sensors::{Radar, Rig};
use crate::space::EgoMotion;
use std::sync::Arc;

/// One radar scan with what the other sensors and the neighbouring scans saw.
///
/// It holds what the settings ask for, and so may hold more than the paper's method looks at.
#[derive(Debug, Clone)]
pub struct Frame<'a> {
    /// All sensors.
    pub rig: &'a Rig,
    /// The radar that made the scan.
    pub radar: &'a Radar,
    /// How the vehicle moved.
    pub motion: &'a EgoMotion,
    /// The scan, in the vehicle frame at its time: the frame in which everything is compared.
    pub scan: Arc<LocatedScan>,
    /// The LiDAR scans nearest in time; `None` where there is none within the tolerance.
    pub lidar: Option<LidarView>,
    /// The LiDAR scans before and after these, in time order: as many to each side as `lidar.window_scans` says, as far
    /// as they exist and can be read. Each is in the vehicle frame at its own time.
    pub lidar_window: Vec<LidarView>,
    /// The ground in the vehicle frame at the scan's time; `None` where there is none.
    pub ground: Option<LocalGround>,
    /// The cameras' images nearest in time for which there is depth.
    pub images: Vec<ImageView>,
    /// The neighbouring radar scans, in time order.
    pub steps: Vec<ScanStep>,
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
    pub fn steps_within(&self, n_b: usize) -> &[ScanStep] {
        let begin = self.steps.partition_point(|step| step.j < 0 && step.j.unsigned_abs() > n_b);
        let end = self.steps.partition_point(|step| step.j < 0 || step.j.unsigned_abs() <= n_b);
        &self.steps[begin..end]
    }

    /// Whether a detection of the scan lies on the floor; none does where there is no ground.
    pub fn is_on_floor(&self, detection: &Detection, config: &GroundConfig) -> bool {
        self.ground.as_ref().is_some_and(|ground| ground.is_floor_detection(self.radar, detection, config))
    }

    /// The range rates of the scan's detections; `None` where the radar measures none.
    pub fn doppler(&self) -> Option<Doppler> {
        Doppler::new(self.radar, &self.scan.measured, self.motion)
    }
    /// The scan's detections with the velocity that their range rates tell; `None` without a position.
    pub fn movers(&self) -> Vec<Option<Mover>> {
        let rates = self.doppler().map(|doppler| doppler.compensated);
        let of_radar = radar_velocity(self.radar, self.scan.t_ns(), self.motion);
        let mut movers = Vec::with_capacity(self.scan.len());
        for (i, detection) in self.scan.detections.iter().enumerate() {
            let rate = rates.as_ref().map_or(f64::NAN, |rates| rates[i]);
            let mover = |detection| Mover::new(self.radar, detection, rate, &of_radar);
            movers.push(detection.as_ref().map(mover));
        }
        movers
    }
}
