//! A recording: one vehicle, some sequences.

use super::places::Place;
use super::rig::Sensors;
use super::sequence::SketchSequence;
use crate::random::{Purpose, Random};
use crate::scenario::ScenarioError;
use crate::simulated::SimulatedSequence;
use crate::spread::{names, spread};
use std::sync::Arc;

/// Sequences.
const COUNT: usize = 4;

/// A vehicle that a seed drew, with its drives through places of one kind.
///
/// ```
/// use ralf::sensors::Source;
/// use ralf_sim::sketch::{Place, Recording};
/// let recording = Recording::new(Place::Lane, 3);
/// let sequence = recording.sequence(0, 2)?;
/// assert_eq!(sequence.truth(0, 1).unwrap().len(), sequence.radar_scan(0, 1).unwrap().len());
/// # Ok::<(), ralf_sim::ScenarioError>(())
/// ```
#[derive(Debug)]
pub struct Recording {
    place: Place,
    sensors: Arc<Sensors>,
    seed: u64,
}

impl Recording {
    /// That of a seed.
    pub fn new(place: Place, seed: u64) -> Self {
        // The same seed gives unrelated recordings in two kinds of places.
        let own =
            place.name().bytes().fold(seed, |seed, byte| seed.wrapping_mul(263).wrapping_add(byte.into()));
        let sensors = Sensors::new(place, &mut Random::new(own, Purpose::World, 0, 0));
        Self { place, sensors: Arc::new(sensors), seed: own }
    }

    /// The sequences' names: `00` to `03`.
    pub fn names(&self) -> Vec<String> {
        names(COUNT)
    }

    /// So many scans of each radar, spread over the sequences; as many as is usual if none are given.
    pub fn spread(&self, scans: Option<usize>) -> Vec<usize> {
        spread(scans, COUNT)
    }

    /// A sequence of so many scans of each radar. What it is like doesn't depend on how long it is.
    pub fn sequence(&self, index: usize, scans: usize) -> Result<SimulatedSequence, ScenarioError> {
        let sequence = SketchSequence::new(self.place, self.sensors.clone(), self.seed, index, scans)?;
        Ok(SimulatedSequence::from_simulation(sequence))
    }
}
