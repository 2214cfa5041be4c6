//! A simulated sequence as a source of measurements.

use super::scenario::{Scenario, ScenarioError};
use super::scenario_sequence::ScenarioSequence;
use super::simulation::Simulation;
use super::truth::Truth;
use ralf::label::Cause;
use ralf::sensors::{
    CameraImage, ClassImage, DepthImage, LidarScan, RadarScan, Sequence, Source, SourceError,
};
use ralf::space::Transform;

/// A sequence made from a scenario and a seed, or one of a [`crate::world::Recording`].
///
/// ```
/// use ralf_sim::{Scenario, SimulatedSequence};
/// use ralf::sensors::Source;
/// let scenario = Scenario::from_toml(&ralf_sim::presets::find("tiny").unwrap().sequences[0].text())?;
/// let sequence = SimulatedSequence::new("00", &scenario, 7, 10)?;
/// let scan = sequence.radar_scan(0, 3)?;
/// assert_eq!(sequence.truth(0, 3).unwrap().len(), scan.len());
/// # Ok::<(), Box<dyn std::error::Error + Send + Sync>>(())
/// ```
#[derive(Debug)]
pub struct SimulatedSequence {
    inner: Box<dyn Simulation>,
    /// Whether its images come with their segmentation.
    segmented: bool,
}

impl SimulatedSequence {
    /// A sequence of so many scans of each radar.
    pub fn new(name: &str, scenario: &Scenario, seed: u64, scans: usize) -> Result<Self, ScenarioError> {
        Ok(Self::from_simulation(ScenarioSequence::new(name, scenario, seed, scans)?))
    }

    pub(super) fn from_simulation(simulation: impl Simulation + 'static) -> Self {
        Self { inner: Box::new(simulation), segmented: false }
    }

    /// The same sequence from a vehicle without cameras: all other measurements are as they were.
    pub fn without_cameras(mut self) -> Self {
        self.inner.remove_cameras();
        self
    }

    /// The same sequence whose images come with what a faultless segmentation network gives: all other measurements are
    /// as they were.
    pub fn with_segmentation(mut self) -> Self {
        self.segmented = true;
        self
    }

    /// Whether its images come with their segmentation.
    pub fn is_segmented(&self) -> bool {
        self.segmented
    }

    /// What is true of each detection of a scan, in its order. The error names a scan that doesn't exist.
    pub fn truth(&self, radar: usize, scan: usize) -> Result<Vec<Truth>, SourceError> {
        self.inner.truth(radar, scan)
    }

    /// The causes that it tells apart, by their numbers.
    pub fn causes(&self) -> &'static [Cause] {
        self.inner.causes()
    }

    /// A radar's true mounting, and what its clock is ahead of the true time, ns: what the rig and the timeline say may
    /// be wrong on purpose. `None` of a radar that doesn't exist.
    pub fn true_radar(&self, radar: usize) -> Option<(Transform, i64)> {
        self.inner.true_radar(radar)
    }

    /// The vehicle's true pose, in its frame at the start: what odometry and poses are measured against.
    pub fn true_pose(&self, t_ns: i64) -> Transform {
        self.inner.true_pose(t_ns)
    }

    /// The true depth of each straight view of an image along its axis, m; the sky is 80 m away.
    pub fn true_depth(&self, camera: usize, image: usize) -> Result<Vec<DepthImage>, SourceError> {
        self.inner.true_depth(camera, image)
    }
}

impl Source for SimulatedSequence {
    fn sequence(&self) -> &Sequence {
        self.inner.sequence()
    }

    fn radar_scan(&self, radar: usize, scan: usize) -> Result<RadarScan, SourceError> {
        self.inner.radar_scan(radar, scan)
    }

    fn lidar_scan(&self, lidar: usize, scan: usize) -> Result<LidarScan, SourceError> {
        self.inner.lidar_scan(lidar, scan)
    }

    fn image(&self, camera: usize, image: usize) -> Result<CameraImage, SourceError> {
        self.inner.image(camera, image)
    }

    fn depth(&self, camera: usize, image: usize) -> Result<Option<Vec<DepthImage>>, SourceError> {
        self.inner.depth(camera, image)
    }

    fn classes(&self, camera: usize, image: usize) -> Result<Option<Vec<ClassImage>>, SourceError> {
        self.segmented.then(|| self.inner.true_classes(camera, image)).transpose()
    }
}
