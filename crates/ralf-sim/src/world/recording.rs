//! A recording: one world, some sequences.

use super::draw::World;
use super::mixture::Mixture;
use super::sequence::WorldSequence;
use crate::random::{Purpose, Random};
use crate::scenario::ScenarioError;
use crate::simulated::SimulatedSequence;
use crate::spread::{names, spread};
use std::sync::Arc;

/// A world that a seed drew from a family or from parts of several, with its sequences.
///
/// ```
/// use ralf::sensors::Source;
/// use ralf_sim::world::{Family, Recording};
/// let recording = Recording::new(Family::find("motorway").unwrap(), 3);
/// let sequence = recording.sequence(0, 2)?;
/// assert_eq!(sequence.truth(0, 1).unwrap().len(), sequence.radar_scan(0, 1).unwrap().len());
/// # Ok::<(), ralf_sim::ScenarioError>(())
/// ```
#[derive(Debug)]
pub struct Recording {
    world: Arc<World>,
    count: usize,
}

impl Recording {
    /// The world of a seed.
    pub fn new(ranges: impl Into<Mixture>, seed: u64) -> Self {
        let mixture: Mixture = ranges.into();
        // The same seed gives unrelated worlds in two families.
        let name = mixture.to_string();
        let own = name.bytes().fold(seed, |seed, byte| seed.wrapping_mul(257).wrapping_add(byte.into()));
        let count = 4 + (3.0 * Random::new(own, Purpose::World, 1, 0).uniform()) as usize;
        Self { world: Arc::new(World::new(mixture, own)), count }
    }

    /// The sequences' names: `00`, `01` and so on, four to six of them.
    pub fn names(&self) -> Vec<String> {
        names(self.count)
    }

    /// So many scans of each radar, spread over the sequences; as many as is usual if none are given.
    pub fn spread(&self, scans: Option<usize>) -> Vec<usize> {
        spread(scans, self.count)
    }

    /// A sequence of so many scans of each radar. What it is like doesn't depend on how long it is.
    pub fn sequence(&self, index: usize, scans: usize) -> Result<SimulatedSequence, ScenarioError> {
        let sequence = WorldSequence::new(self.world.clone(), index, scans)?;
        Ok(SimulatedSequence::from_simulation(sequence))
    }
}
