//! What can be measured of a detection that tells against its label, or for another, in a word.

use super::SequenceEvidence;
use ralf::learned::Rows;

/// What the detections of a kind have in common, by what can be measured of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Sign {
    /// Their Doppler velocity says that they move.
    Moves,
    /// Most of their scan is stronger.
    Weak,
    /// They lie no higher than the ground may.
    Ground,
    /// Something tall stands in the radar's way to them.
    Behind,
    /// Most LiDAR scans look through the place.
    Free,
    /// Most scans that could see them again did.
    Again,
    /// None of these.
    Rest,
}

impl Sign {
    /// All of them, in their order.
    pub const ALL: [Self; 7] =
        [Self::Moves, Self::Weak, Self::Ground, Self::Behind, Self::Free, Self::Again, Self::Rest];

    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Moves => "moves",
            Self::Weak => "weak",
            Self::Ground => "ground",
            Self::Behind => "behind",
            Self::Free => "free",
            Self::Again => "again",
            Self::Rest => "rest",
        }
    }
}

/// How surely a detection moves, sigmas.
const MOVES: f32 = 2.0;
/// The share of its scan that may be weaker than what is weak.
const WEAK: f32 = 0.2;
/// How high over the ground a detection may lie and still be of it, sigmas.
const GROUND: f32 = 1.0;
/// How far behind what stands in the way, m.
const BEHIND: f32 = 0.5;
/// The share of LiDAR scans that look through what is free.
const FREE: f32 = 0.5;
/// The share of scans that saw what is seen again.
const AGAIN: f32 = 0.8;

/// Where the columns are that signs are read from.
pub(super) struct Signs {
    moves: Option<usize>,
    weak: Option<usize>,
    ground: Option<usize>,
    behind: Option<usize>,
    free: Option<usize>,
    again: Option<usize>,
}

impl Signs {
    pub(super) fn of(observed: &SequenceEvidence) -> Self {
        let place = |name: &str| observed.place_of(name);
        Self {
            moves: place("doppler_residual"),
            weak: place("amplitude_rank"),
            ground: place("ground_height_sigmas"),
            behind: place("sight_behind_first_tall"),
            free: place("lidar_free"),
            again: place("persistence_moving"),
        }
    }

    /// The first that a detection shows, of those that tell something against its label or for another.
    pub(super) fn sign(&self, rows: &Rows, at: usize, plausible: bool) -> Sign {
        // What wasn't observed is NaN, and no comparison holds.
        let value = |place: Option<usize>| place.map_or(f32::NAN, |place| rows.row(at)[place]);
        if value(self.moves).abs() > MOVES {
            return Sign::Moves;
        }
        if value(self.weak) <= WEAK {
            return Sign::Weak;
        }
        if !plausible {
            return if value(self.again) >= AGAIN { Sign::Again } else { Sign::Rest };
        }
        if value(self.ground) < GROUND {
            return Sign::Ground;
        }
        if value(self.behind) > BEHIND {
            return Sign::Behind;
        }
        if value(self.free) >= FREE { Sign::Free } else { Sign::Rest }
    }
}
