//! Where measurements come from: one sequence of one recording, read on demand.

use crate::sensors::{CameraImage, ClassImage, DepthImage, DepthOutput, LidarScan, RadarScan, Rig};
use crate::space::EgoMotion;
use std::ops::RangeInclusive;

/// Times (ns) lie within 146 years of 0, so that the difference of two is a time as well.
pub const KNOWN_NS: RangeInclusive<i64> = -i64::MAX / 2..=i64::MAX / 2;

/// Why a measurement could not be had. It names the file, the place in it, what was expected and what was found.
pub type SourceError = Box<dyn std::error::Error + Send + Sync>;

/// What is known of a sequence before any measurement is read.
#[derive(Debug, Clone)]
pub struct Sequence {
    /// The folder's or scene's name, unique in its recording.
    pub name: String,
    /// A title for people.
    pub title: String,
    /// The sensors.
    pub rig: Rig,
    /// When each of them delivered.
    pub times: Timelines,
    /// How the vehicle moved.
    pub motion: EgoMotion,
    /// What the stored depth images hold.
    pub depth_output: DepthOutput,
}

/// Times (ns) of all measurements: one list per sensor, in the rig's order.
///
/// All are of one clock and in [`KNOWN_NS`]. Each list ascends; several measurements of a sensor
/// may have one time, and keep their order.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Timelines {
    /// Times of each radar's scans.
    pub radars: Vec<Vec<i64>>,
    /// Times of each LiDAR's scans.
    pub lidars: Vec<Vec<i64>>,
    /// Times of each camera's images.
    pub cameras: Vec<Vec<i64>>,
}

impl Timelines {
    /// How many measurements all sensors delivered.
    pub fn measurements(&self) -> usize {
        let Self { radars, lidars, cameras } = self;
        radars.iter().chain(lidars).chain(cameras).map(Vec::len).sum()
    }
}

/// One sequence of a recording. Readers are indexed by the sensor's place in the rig and the measurement's in its
/// timeline.
///
/// Any measurement may be asked for at any time and from any thread, and asking twice gives the same. The `t_ns` of a
/// scan is the one that its sensor's timeline gives it: a `FrameWindow`, and so every run, refuses a scan of
/// another time, and a sequence whose timelines don't ascend.
pub trait Source: Send + Sync {
    /// Sensors, times and motion.
    fn sequence(&self) -> &Sequence;

    /// A radar's scan.
    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError>;

    /// A LiDAR's scan.
    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError>;

    /// A camera's image, decoded. One of another size than the camera's is refused by an
    /// [`ImageSizeError`](super::ImageSizeError).
    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError>;

    /// What a depth network gave for each view of an image; `None` where nothing is stored.
    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError>;

    /// What a segmentation network gave for each view of an image; `None` where nothing is stored.
    fn classes(&self, _camera: usize, _image: usize) -> Result<Option<Vec<ClassImage>>, SourceError> {
        Ok(None)
    }
}
