//! The ground under the vehicle (docs/method.md, sections 4 and 13).

mod chosen;
mod local;
mod plane;
mod polar;
mod ransac;

pub(super) use chosen::ids_where;
pub(super) use local::Floor;
pub use local::GroundSurface;
pub use plane::Plane;

use crate::config::{GroundConfig, GroundModel};
use crate::space::Point;
use polar::PolarGround;
use ransac::Candidates;
use std::sync::Arc;

/// The ground, in the frame it was fitted in.
#[derive(Debug, Clone)]
pub enum Ground {
    /// One plane everywhere.
    Plane(Plane),
    /// A plane per concentric sector.
    Polar(PolarGround),
    /// A surface that follows the ground, and a plane where none of it was seen near by.
    Local {
        /// The surface.
        surface: Arc<GroundSurface>,
        /// The plane of the whole scan; z = 0 where none fits.
        elsewhere: Plane,
    },
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
            GroundModel::Local => {
                let surface = Arc::new(GroundSurface::fit(points)?);
                let plane = ransac::fit(&Candidates::admissible(points, config), config, seed);
                Some(Self::Local { surface, elsewhere: plane.unwrap_or(Plane::HORIZONTAL) })
            }
        }
    }

    /// The plane that is the ground at a point, or touches it there.
    pub fn plane_at(&self, p: &Point) -> Plane {
        match self {
            Self::Plane(plane) => *plane,
            Self::Polar(polar) => *polar.plane_at(p.x, p.y),
            Self::Local { surface, elsewhere } => surface.plane_at(p.x, p.y).unwrap_or(*elsewhere),
        }
    }

    /// Height above the ground, m: along its normal, and upright above a surface.
    pub fn height(&self, p: &Point) -> f64 {
        match self {
            Self::Plane(plane) => plane.height(p),
            Self::Polar(polar) => polar.plane_at(p.x, p.y).height(p),
            Self::Local { surface, elsewhere } => surface.height(p).unwrap_or_else(|| elsewhere.height(p)),
        }
    }

    /// Which points lie at least so high above the ground, m; those that are not finite don't.
    pub fn ids_above(&self, points: &[[f32; 3]], margin: f64) -> Vec<u32> {
        match self {
            // Of the one plane it is told in a loop of its own, for it is the usual ground.
            Self::Plane(plane) => ids_as_high(points, margin, |p| plane.height(p)),
            _ => ids_as_high(points, margin, |p| self.height(p)),
        }
    }
}

fn ids_as_high(points: &[[f32; 3]], margin: f64, height: impl Fn(&Point) -> f64) -> Vec<u32> {
    ids_where(points, |point| point[0].is_finite() && height(&Point::from(point.map(f64::from))) >= margin)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_finite_lies_above_no_ground() {
        let tilted = Plane::through(&Point::origin(), crate::space::Vector::new(0.1, 0.0, 1.0)).unwrap();
        let points =
            [[0.0, 0.0, 1.0], [f32::INFINITY, 0.0, 1.0], [f32::NAN; 3], [0.0, 0.0, 0.1], [5.0, 0.0, 0.5]];
        assert_eq!(Ground::Plane(tilted).ids_above(&points, 0.3), [0, 4]);
    }

    /// A ramp of 14 % from 10 m to 40 m ahead, level beyond.
    fn ramp_at(x: f64) -> f64 {
        0.14 * (x - 10.0).clamp(0.0, 30.0)
    }

    /// Points 0.4 m apart on the ramp, and on a car there, of which the LiDAR sees the near side and the roof.
    fn ramp() -> Vec<[f32; 3]> {
        let mut points = Vec::new();
        for i in -100..175 {
            for j in -50..50 {
                let (x, y) = (f64::from(i) * 0.4, f64::from(j) * 0.4);
                let on_car = (22.0..26.5).contains(&x) && y.abs() < 0.9;
                points.push([x as f32, y as f32, (ramp_at(x) + if on_car { 1.4 } else { 0.0 }) as f32]);
            }
        }
        points
    }

    fn fitted(points: &[[f32; 3]], model: GroundModel) -> Ground {
        Ground::fit(points, &GroundConfig { model, ..GroundConfig::default() }, 1).unwrap()
    }

    #[test]
    fn the_local_ground_follows_a_ramp_where_one_plane_cannot() {
        let points = ramp();
        let worst = |model| {
            let ground = fitted(&points, model);
            let places =
                [-30.0, 5.0, 15.0, 24.0, 30.0, 38.0, 50.0, 65.0].map(|x| Point::new(x, 0.3, ramp_at(x)));
            places.iter().map(|p| ground.height(p).abs()).fold(0.0, f64::max)
        };
        assert!(worst(GroundModel::Local) < 0.1, "local is off by {} m", worst(GroundModel::Local));
        assert!(worst(GroundModel::Plane) > 1.0, "the plane is off by {} m", worst(GroundModel::Plane));
    }

    #[test]
    fn the_local_plane_touches_the_ramp() {
        let points = ramp();
        let ground = fitted(&points, GroundModel::Local);
        let p = Point::new(33.0, -7.0, ramp_at(33.0) + 1.0);
        // The normal of a rise of 14 %.
        let normal = crate::space::Vector::new(-0.14, 0.0, 1.0).normalize();
        assert!((ground.plane_at(&p).normal - normal).norm() < 1e-3);
        assert!(
            (ground.plane_at(&p).height(&p) - normal.z).abs() < 0.02
                && (ground.height(&p) - 1.0).abs() < 0.02
        );
    }

    #[test]
    fn where_no_ground_was_seen_the_plane_goes_on() {
        let flat: Vec<_> =
            (0..10_000).map(|i| [(i % 100) as f32 * 0.4, (i / 100) as f32 * 0.4, 0.1]).collect();
        let ground = fitted(&flat, GroundModel::Local);
        for p in [Point::new(-60.0, -60.0, 1.1), Point::new(500.0, 3.0, 1.1)] {
            assert!(
                (ground.height(&p) - 1.0).abs() < 0.01 && (ground.plane_at(&p).height(&p) - 1.0).abs() < 0.01
            );
        }
        let config = GroundConfig { model: GroundModel::Local, ..GroundConfig::default() };
        assert!(Ground::fit(&[[5.0, 0.0, 40.0], [f32::NAN; 3]], &config, 1).is_none());
    }
}
