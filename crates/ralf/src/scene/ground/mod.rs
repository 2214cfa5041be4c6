//! The ground under the vehicle (docs/method.md, sections 4 and 13).

mod local;
mod plane;
mod polar;
mod ransac;

pub(super) use local::Floor;
pub use local::GroundSurface;
pub use plane::Plane;

use crate::config::{GroundConfig, GroundModel};
use crate::space::Point;
use polar::PolarGround;
use ransac::Candidates;

/// The ground, in the frame it was fitted in.
#[derive(Debug, Clone)]
pub enum Ground {
    /// One plane everywhere.
    Plane(Plane),
    /// A plane per concentric sector.
    Polar(PolarGround),
}

impl Ground {
    /// z = 0 of the frame.
    pub fn flat() -> Self {
        Self::Plane(Plane::HORIZONTAL)
    }

    /// Fits the configured ground to LiDAR points (vehicle frame, m; not finite where there was no return).
    /// `None` where the model is `none`, and where no admissible plane is found.
    pub fn fit(points: &[[f32; 3]], config: &GroundConfig, seed: u64) -> Option<Self> {
        match config.model {
            GroundModel::None => None,
            GroundModel::Flat => Some(Self::flat()),
            GroundModel::Plane => {
                ransac::fit(&Candidates::admissible(points, config), config, seed).map(Self::Plane)
            }
            GroundModel::Polar => {
                let candidates = Candidates::admissible(points, config);
                let plane = ransac::fit(&candidates, config, seed)?;
                Some(Self::Polar(PolarGround::fit(&candidates, plane, config)))
            }
        }
    }

    /// The plane that is the ground at a point.
    pub fn plane_at(&self, p: &Point) -> &Plane {
        match self {
            Self::Plane(plane) => plane,
            Self::Polar(polar) => polar.plane_at(p.x, p.y),
        }
    }

    /// Height above the ground along its normal, m.
    pub fn height(&self, p: &Point) -> f64 {
        self.plane_at(p).height(p)
    }
}
