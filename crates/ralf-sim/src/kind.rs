//! What things are made of, and what that means for labels and for each sensor.

use serde::{Deserialize, Serialize};

/// Thickness of a deck overhead, m.
pub(super) const DECK: f64 = 0.6;

/// What a surface belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// The ground wherever nothing else lies on it.
    Road,
    /// Raised, with a kerb.
    Sidewalk,
    /// Paint on the road.
    Marking,
    /// Grass: plausible by the paper's policy.
    Grass,
    /// A building with facades.
    Building,
    /// Walls and a roof with an open front, turned to +x.
    Garage,
    /// A car.
    Car,
    /// A person on foot.
    Pedestrian,
    /// A lamp post or a sign's pole.
    Pole,
    /// A tree: trunk and crown.
    Tree,
    /// A clipped hedge.
    Hedge,
    /// A fence.
    Fence,
    /// A lorry or a bus.
    Truck,
    /// A bicycle with its rider.
    Cyclist,
    /// A guard rail of steel on posts.
    Rail,
    /// A wall of concrete: a noise barrier, a median, a retaining wall.
    Wall,
    /// A deck overhead, its top so high: a bridge, a gantry, a tunnel's ceiling.
    Bridge,
    /// A container, a skip, a cabinet: a box of sheet metal.
    Container,
    /// A traffic sign on its pole, turned to +x.
    Sign,
}

impl Kind {
    /// The SemanticKITTI id of a radar detection by the paper's policy: 1 where it is an artifact even on its surface.
    pub fn class(self) -> u16 {
        match self {
            Self::Road | Self::Sidewalk | Self::Marking => 1,
            Self::Grass => 72,
            Self::Building | Self::Garage => 50,
            Self::Car => 10,
            Self::Pedestrian => 30,
            Self::Pole => 80,
            Self::Tree | Self::Hedge => 70,
            Self::Fence | Self::Rail | Self::Wall => 51,
            Self::Truck => 18,
            Self::Cyclist => 31,
            Self::Bridge | Self::Container => 52,
            Self::Sign => 81,
        }
    }

    /// SemanticKITTI id of what a camera sees: other than a radar detection, it may be ground.
    pub(super) fn seen_class(self) -> u16 {
        match self {
            Self::Road => 40,
            Self::Sidewalk => 48,
            Self::Marking => 60,
            other => other.class(),
        }
    }

    /// Length, width and height where the scenario gives none, m.
    pub(super) fn usual_size(self) -> [f64; 3] {
        match self {
            Self::Road => [1.0, 1.0, 0.0],
            Self::Sidewalk => [10.0, 2.0, 0.12],
            Self::Marking => [3.0, 0.15, 0.005],
            Self::Grass => [10.0, 4.0, 0.06],
            Self::Building => [14.0, 10.0, 9.0],
            Self::Garage => [14.0, 9.0, 3.2],
            Self::Car => [4.4, 1.8, 1.48],
            Self::Pedestrian => [0.5, 0.5, 1.75],
            Self::Pole => [0.18, 0.18, 5.0],
            Self::Tree => [4.0, 4.0, 6.0],
            Self::Hedge => [8.0, 0.9, 1.3],
            Self::Fence => [10.0, 0.06, 1.6],
            Self::Truck => [11.0, 2.5, 3.6],
            Self::Cyclist => [1.75, 0.5, 1.75],
            Self::Rail => [4.0, 0.15, 0.75],
            Self::Wall => [4.0, 0.3, 1.1],
            Self::Bridge => [12.0, 10.0, 5.6],
            Self::Container => [6.1, 2.44, 2.6],
            Self::Sign => [0.08, 0.8, 2.6],
        }
    }

    /// Whether it lies flat on the ground.
    pub(super) fn is_flat(self) -> bool {
        matches!(self, Self::Road | Self::Sidewalk | Self::Marking | Self::Grass)
    }

    /// What a body of this kind takes from a radar's echo that passes through it, dB; `None` where nothing passes.
    /// Waves find their way around and under cars, and through leaves.
    pub(super) fn radar_loss_db(self) -> Option<f64> {
        match self {
            Self::Building | Self::Garage | Self::Wall | Self::Bridge | Self::Container => None,
            Self::Truck => Some(15.0),
            Self::Car => Some(9.0),
            Self::Tree | Self::Hedge | Self::Rail | Self::Sign => Some(4.0),
            Self::Pedestrian | Self::Fence | Self::Cyclist => Some(3.0),
            Self::Pole => Some(1.0),
            Self::Road | Self::Sidewalk | Self::Marking | Self::Grass => Some(0.0),
        }
    }
}
