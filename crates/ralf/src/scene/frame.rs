//! Everything that is known around one radar scan.

use super::camera::{ImageView, SegmentedView};
use super::doppler::{Doppler, radar_velocity};
use super::floor::LocalGround;
use super::lidar::LidarView;
use super::lidar_cloud::LidarCloud;
use super::lidar_window::LidarWindowView;
use super::located::{Detection, LocatedScan};
use super::mover::Mover;
use super::neighbouring::{NeighbouringScan, ScanStep};
use super::strength::Strength;
use crate::config::GroundConfig;
use crate::sensors::{Elevation, Radar, Rig};
use crate::space::{EgoMotion, NeighborIndex};
use std::borrow::Cow;
use std::sync::{Arc, OnceLock};

/// One radar scan with what the other sensors and the neighbouring scans saw.
///
/// It may hold more than the paper's method looks at.
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
    /// The other LiDAR scans of `lidar.scans`, in time order.
    pub lidar_neighbours: Vec<LidarView>,
    /// The LiDAR scans of the seconds around, accumulated; `None` where there are none, and unless the
    /// [`FrameWindow`](super::FrameWindow) gathers what evidence looks at.
    pub lidar_window: Option<LidarWindowView>,
    /// All radars' scans of the tenths of a second around, this one apart, in time order; empty unless the window
    /// gathers what evidence looks at.
    pub radar_window: Vec<NeighbouringScan>,
    /// The ground in the vehicle frame at the scan's time; `None` where there is none.
    pub ground: Option<LocalGround>,
    /// The cameras' images nearest in time for which there is depth.
    pub images: Vec<ImageView>,
    /// The cameras' images nearest in time for which a segmentation is stored.
    pub segmented: Vec<SegmentedView>,
    /// The neighbouring radar scans, in time order.
    pub steps: Vec<ScanStep>,
    /// LiDAR scans and segmentations that belong to it and can't be read, and LiDAR scans of which nothing came back:
    /// the scan is labelled without them.
    pub unreadable: Vec<Unreadable>,
    /// All measurements of which it wanted something that could not be read, be it only just then: another time it may
    /// be another frame. Sorted, each but once.
    pub not_read: Vec<NotRead>,
    /// Of the LiDAR's points, for a radar that measures no elevation: made where [`Self::lidar_cloud`] is first asked.
    pub(super) horizontal_index: OnceLock<NeighborIndex>,
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

/// A measurement of any sensor that could not be read.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct NotRead {
    /// Which list of the rig the sensor is in.
    pub kind: SensorKind,
    /// Its place in that list.
    pub sensor: usize,
    /// The measurement's place in the sensor's timeline, from 0.
    pub index: usize,
    /// File, place, expected, found.
    pub reason: String,
}

/// The kinds of sensors that a rig tells apart.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum SensorKind {
    /// Its measurements are scans.
    Radar,
    /// Its measurements are scans.
    Lidar,
    /// Its measurements are images, with their depth and segmentation.
    Camera,
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

    /// The LiDAR points above the ground, to be searched; `None` without any LiDAR scan.
    pub fn lidar_cloud(&self) -> Option<LidarCloud<'_>> {
        let view = self.lidar.as_ref()?;
        if self.radar.elevation == Elevation::Measured {
            return Some(LidarCloud::new(view, self.radar));
        }
        let index = || view.moment.horizontal_index(self.radar, &view.vehicle_from_moment);
        let index = self.horizontal_index.get_or_init(index);
        Some(LidarCloud::horizontal(view, Cow::Borrowed(index)))
    }

    /// The clouds of all scans of `lidar.scans`: that of the nearest ones, which is [`Self::lidar_cloud`], and then the
    /// others in time order. None without any LiDAR scan.
    pub fn lidar_clouds(&self) -> Vec<LidarCloud<'_>> {
        let others = self.lidar_neighbours.iter().map(|view| LidarCloud::new(view, self.radar));
        self.lidar_cloud().into_iter().chain(others).collect()
    }

    /// The range rates of the scan's detections; `None` where the radar measures none.
    pub fn doppler(&self) -> Option<&Doppler> {
        self.scan.doppler(self.radar, self.motion)
    }

    /// The scan's detections with the velocity that their range rates tell; `None` without a position.
    pub fn movers(&self) -> Vec<Option<Mover>> {
        let rates = self.doppler().map(|doppler| &doppler.compensated);
        let of_radar = radar_velocity(self.radar, self.scan.t_ns(), self.motion);
        let mut movers = Vec::with_capacity(self.scan.len());
        for (i, detection) in self.scan.detections.iter().enumerate() {
            let rate = rates.map_or(f64::NAN, |rates| rates[i]);
            let mover = |detection| Mover::new(self.radar, detection, rate, &of_radar);
            movers.push(detection.as_ref().map(mover));
        }
        movers
    }

    /// The scans of the `radar_window` that the same radar made.
    pub fn own_scans_around(&self) -> impl Iterator<Item = &NeighbouringScan> {
        self.radar_window.iter().filter(|neighbour| self.is_own(neighbour.radar))
    }

    /// Whether a radar, by its place in the rig, is the one that made the scan.
    pub fn is_own(&self, radar: usize) -> bool {
        self.rig.radars[radar].name == self.radar.name
    }

    /// How strong the echoes of the scan's detections were; `None` where the radar doesn't measure it.
    pub fn strength(&self) -> Option<&Strength> {
        self.scan.strength(self.radar)
    }
}
