//! The places of sketched worlds.

mod gardens;
mod lane;
mod quay;
mod ring;

use super::relief::Relief;
use super::scene::{Draft, Ground, Scene};
use super::way::Way;
use crate::random::Random;
use crate::scenario::Leg;

/// A kind of place, with the sensors that are usual there.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Place {
    /// Containers on wet concrete, cranes, carriers.
    Quay,
    /// A road of two carriageways with crash barriers.
    Ring,
    /// A lane through an old town, with a market.
    Lane,
    /// Gravel between hedges, wire fences and sheds on a slope.
    Gardens,
}

/// All of them.
pub const PLACES: [Place; 4] = [Place::Quay, Place::Ring, Place::Lane, Place::Gardens];

impl Place {
    /// For the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Quay => "quay",
            Self::Ring => "ring",
            Self::Lane => "lane",
            Self::Gardens => "gardens",
        }
    }

    /// The place of a name.
    pub fn find(name: &str) -> Option<Self> {
        PLACES.into_iter().find(|place| place.name() == name)
    }

    /// A site of this kind.
    pub(super) fn site(self, random: &mut Random) -> Site {
        match self {
            Self::Quay => quay::quay(random),
            Self::Ring => ring::ring(random),
            Self::Lane => lane::lane(random),
            Self::Gardens => gardens::gardens(random),
        }
    }
}

/// A site, and how it is driven through.
#[derive(Debug)]
pub(super) struct Site {
    pub(super) scene: Scene,
    pub(super) way: Way,
    /// m/s, usually.
    pub(super) speed: f64,
}

/// What is different from site to site in the same way everywhere.
struct Lie {
    slope: [f64; 2],
    /// Heights and lengths of swells, m.
    swells: Vec<[f64; 2]>,
    ground: Ground,
}

fn draft(lie: Lie, random: &mut Random) -> Draft<'_> {
    let relief = Relief::new(lie.slope, &lie.swells, random);
    let scene =
        Scene { relief, ground: lie.ground, things: Vec::new(), bodies: Vec::new(), spots: Vec::new() };
    Draft { scene, random }
}

/// Bends one after the other, of at most so many degrees, to either side.
fn bends(random: &mut Random, count: usize, length: [f64; 2], most_deg: f64) -> Vec<Leg> {
    let leg = |_| Leg {
        length: random.between(length[0], length[1]),
        turn_deg: random.between(-most_deg, most_deg),
    };
    (0..count).map(leg).collect()
}

/// Every so many metres from one place along a way to another.
fn steps(from: f64, to: f64, step: f64) -> impl Iterator<Item = f64> {
    (0..((to - from) / step).max(0.0) as usize).map(move |index| from + step * index as f64)
}
