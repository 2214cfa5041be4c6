//! What every simulated sequence can do.

use super::truth::Truth;
use ralf::label::Cause;
use ralf::sensors::{ClassImage, DepthImage, Source, SourceError};
use ralf::space::Transform;
use std::fmt::Debug;
use std::sync::{Arc, Mutex};

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

/// Radar, scan, and what it found.
type Asked<T> = (usize, usize, Arc<Vec<T>>);

/// What was asked for last: who writes a scan asks for its truth, too.
#[derive(Debug)]
pub(super) struct Last<T>(Mutex<Option<Asked<T>>>);

impl<T> Default for Last<T> {
    fn default() -> Self {
        Self(Mutex::new(None))
    }
}

impl<T> Last<T> {
    /// A scan of a radar as it was made last, or made now.
    pub(super) fn or_made(
        &self,
        radar: usize,
        scan: usize,
        make: impl FnOnce() -> Result<Vec<T>, SourceError>,
    ) -> Result<Arc<Vec<T>>, SourceError> {
        if let Ok(last) = self.0.lock()
            && let Some((.., found)) = last.as_ref().filter(|last| (last.0, last.1) == (radar, scan))
        {
            return Ok(found.clone());
        }
        let found = Arc::new(make()?);
        if let Ok(mut last) = self.0.lock() {
            *last = Some((radar, scan, found.clone()));
        }
        Ok(found)
    }
}
