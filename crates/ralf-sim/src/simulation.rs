//! What every simulated sequence can do.

use super::truth::Truth;
use ralf::label::Cause;
use ralf::sensors::{ClassImage, DepthImage, Source, SourceError};
use ralf::space::Transform;
use std::fmt::Debug;

/// A source whose truth is known.
pub(super) trait Simulation: Source + Debug {
    /// What is true of each detection of a scan, in its order.
    fn truth(&self, radar: usize, scan: usize) -> Result<Vec<Truth>, SourceError>;

    /// The causes that it tells apart, by their numbers.
    fn causes(&self) -> &'static [Cause];

    /// Takes the cameras off the vehicle; all other measurements stay as they are.
    fn remove_cameras(&mut self);

    /// A radar's true mounting, and what its clock is ahead of the true time, ns.
    fn true_radar(&self, radar: usize) -> Option<(Transform, i64)>;

    /// The vehicle's true pose, in its frame at the start.
    fn true_pose(&self, t_ns: i64) -> Transform;

    /// The true depth of each straight view of an image along its axis, m.
    fn true_depth(&self, camera: usize, image: usize) -> Result<Vec<DepthImage>, SourceError>;

    /// The true classes of each straight view of an image.
    fn true_classes(&self, camera: usize, image: usize) -> Result<Vec<ClassImage>, SourceError>;
}

/// Time of a measurement, ns.
pub(super) fn time(kind: &str, times: &[Vec<i64>], sensor: usize, index: usize) -> Result<i64, SourceError> {
    let found = times.get(sensor).and_then(|times| times.get(index)).copied();
    found.ok_or_else(|| format!("{kind} {sensor} has no measurement {index}").into())
}
