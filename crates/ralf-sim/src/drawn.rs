//! Whatever a seed draws: recordings of both makes by one name.

use super::scenario::ScenarioError;
use super::simulated::SimulatedSequence;
use super::sketch::{self, PLACES, Place};
use super::world::{self, FAMILIES, Mixture};
use std::fmt;

/// Worlds of one kind, of which a seed draws one.
///
/// ```
/// use ralf_sim::Worlds;
/// let worlds = Worlds::find("lane").unwrap();
/// assert_eq!(worlds.to_string(), "lane");
/// assert_eq!(worlds.recording(7).sequence(0, 2)?.truth(0, 0).is_ok(), true);
/// assert!(Worlds::all().any(|known| known == ("lane", worlds)) && Worlds::find("moon").is_none());
/// # Ok::<(), ralf_sim::ScenarioError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Worlds {
    /// By physics, of a family or a mixture of three.
    Family(Mixture),
    /// Sketched ones.
    Sketch(Place),
}

impl Worlds {
    /// Each family and each place of sketches, by its name.
    pub fn all() -> impl Iterator<Item = (&'static str, Self)> {
        let families = FAMILIES.iter().map(|family| (family.name, Self::Family(family.into())));
        families.chain(PLACES.into_iter().map(|place| (place.name(), Self::Sketch(place))))
    }

    /// By the name of a family or a place, a family's number, or three families with `+` between them.
    pub fn find(text: &str) -> Option<Self> {
        let family = Mixture::find(text).map(Self::Family);
        family.or_else(|| Place::find(text).map(Self::Sketch))
    }

    /// What a seed draws.
    pub fn recording(self, seed: u64) -> DrawnRecording {
        DrawnRecording(match self {
            Self::Family(mixture) => Make::World(world::Recording::new(mixture, seed)),
            Self::Sketch(place) => Make::Sketch(sketch::Recording::new(place, seed)),
        })
    }
}

impl fmt::Display for Worlds {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Family(mixture) => mixture.fmt(f),
            Self::Sketch(place) => f.write_str(place.name()),
        }
    }
}

/// A recording that a seed drew.
#[derive(Debug)]
pub struct DrawnRecording(Make);

#[derive(Debug)]
enum Make {
    World(world::Recording),
    Sketch(sketch::Recording),
}

impl DrawnRecording {
    /// The sequences' names: `00`, `01` and so on.
    pub fn names(&self) -> Vec<String> {
        match &self.0 {
            Make::World(recording) => recording.names(),
            Make::Sketch(recording) => recording.names(),
        }
    }

    /// So many scans of each radar, spread over the sequences; as many as is usual if none are given.
    pub fn spread(&self, scans: Option<usize>) -> Vec<usize> {
        match &self.0 {
            Make::World(recording) => recording.spread(scans),
            Make::Sketch(recording) => recording.spread(scans),
        }
    }

    /// A sequence of so many scans of each radar. What it is like doesn't depend on how long it is.
    ///
    /// # Errors
    /// No scans.
    pub fn sequence(&self, index: usize, scans: usize) -> Result<SimulatedSequence, ScenarioError> {
        match &self.0 {
            Make::World(recording) => recording.sequence(index, scans),
            Make::Sketch(recording) => recording.sequence(index, scans),
        }
    }
}
