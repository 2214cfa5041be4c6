//! A ground that follows slopes and kerbs: a plane per concentric sector (not in the paper, which names slopes as a
//! failure of its single plane).

use super::plane::{Plane, PlaneSums};
use super::ransac::Candidates;
use crate::config::GroundConfig;
use crate::space::Point;
use std::f64::consts::TAU;

/// Outer radii of the rings, m; the last one reaches to infinity.
const RINGS: [f64; 6] = [8.0, 14.0, 22.0, 34.0, 50.0, f64::INFINITY];
const SECTORS: usize = 16;
/// Points that a sector's plane needs at least.
const MIN_POINTS: usize = 12;
/// Refinements of a sector's plane.
const ROUNDS: usize = 3;
/// A sector's plane is sought this far above and below the one inside it, m.
const STEP: f64 = 0.5;

/// A plane for each sector of each ring. A sector with too few points takes the plane of the one inside it.
#[derive(Debug, Clone)]
pub struct PolarGround {
    planes: Vec<Plane>,
}

impl PolarGround {
    /// Outward along each sector, from the plane of the whole scan.
    pub(super) fn fit(candidates: &Candidates, whole: Plane, config: &GroundConfig) -> Self {
        let mut members: Vec<Vec<u32>> = vec![Vec::new(); RINGS.len() * SECTORS];
        for i in 0..candidates.len() {
            let p = candidates.point(i);
            members[sector_of(p.x, p.y)].push(i as u32);
        }
        let mut planes: Vec<Plane> = Vec::with_capacity(members.len());
        for (sector, points) in members.iter().enumerate() {
            let inside = sector.checked_sub(SECTORS).map_or(whole, |inside| planes[inside]);
            planes.push(fit_sector(candidates, points, inside, config).unwrap_or(inside));
        }
        Self { planes }
    }

    pub(super) fn plane_at(&self, x: f64, y: f64) -> &Plane {
        &self.planes[sector_of(x, y)]
    }
}

fn sector_of(x: f64, y: f64) -> usize {
    let ring = RINGS.iter().position(|outer| x.hypot(y) < *outer).unwrap_or(RINGS.len() - 1);
    let turn = (y.atan2(x) / TAU).rem_euclid(1.0);
    ring * SECTORS + ((turn * SECTORS as f64) as usize).min(SECTORS - 1)
}

/// Refines the plane of the inner sector on this sector's points, the window around it closing from [`STEP`] to the
/// inlier distance: first toward the lowest points, then toward all that fit. `None` where too few points support it.
fn fit_sector(
    candidates: &Candidates,
    points: &[u32],
    inside: Plane,
    config: &GroundConfig,
) -> Option<Plane> {
    let heights = |plane: &Plane| -> Vec<(f64, u32)> {
        points.iter().map(|i| (plane.height(&Point::from(candidates.point(*i as usize))), *i)).collect()
    };
    let mut near: Vec<_> = heights(&inside).into_iter().filter(|(height, _)| height.abs() <= STEP).collect();
    if near.len() < MIN_POINTS {
        return None;
    }
    near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    // The ground is the lowest surface: a low quantile survives cars and hedges above it and stray points below.
    let shift = near[near.len() / 5].0;
    let mut plane = Plane { offset: inside.offset + shift, ..inside };
    for _ in 0..ROUNDS {
        let mut sums = PlaneSums::default();
        let inliers =
            heights(&plane).into_iter().filter(|(height, _)| height.abs() <= config.inlier_distance);
        let count = inliers.map(|(_, i)| sums.add(candidates.point(i as usize))).count();
        plane = sums.plane().filter(|next| count >= MIN_POINTS && follows(next, &inside, config))?;
    }
    Some(plane)
}

/// Whether a plane is a ground that can follow the one inside it: no steeper than allowed against up and against that
/// one.
fn follows(next: &Plane, inside: &Plane, config: &GroundConfig) -> bool {
    let limit = config.max_tilt_deg.to_radians().cos();
    next.normal.z >= limit && next.normal.dot(&inside.normal) >= limit
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::GroundModel;
    use crate::scene::ground::Ground;

    /// Flat up to 15 m ahead, then rising by 8 %; with a box standing on it.
    fn hill() -> (Vec<[f32; 3]>, impl Fn(f64) -> f64) {
        let height = |x: f64| 0.08 * (x - 15.0).max(0.0);
        let mut points = Vec::new();
        for i in -200..240 {
            for j in -40..40 {
                let (x, y) = (f64::from(i) * 0.2, f64::from(j) * 0.4);
                let boxed = (20.0..22.0).contains(&x) && y.abs() < 1.0;
                points.push([x as f32, y as f32, (height(x) + if boxed { 1.5 } else { 0.0 }) as f32]);
            }
        }
        (points, height)
    }

    #[test]
    fn follows_a_slope_where_one_plane_cannot() {
        let (points, height) = hill();
        let worst = |model| {
            let config = GroundConfig { model, ..GroundConfig::default() };
            let ground = Ground::fit(&points, &config, 1).unwrap();
            let errors = [5.0, 12.0, 25.0, 32.0, 40.0, 45.0]
                .map(|x| ground.height(&Point::new(x, 2.0, height(x))).abs());
            errors.into_iter().fold(0.0, f64::max)
        };
        assert!(worst(GroundModel::Polar) < 0.12, "polar is off by {} m", worst(GroundModel::Polar));
        assert!(
            worst(GroundModel::Plane) > 0.5,
            "the single plane is off by {} m",
            worst(GroundModel::Plane)
        );
    }

    #[test]
    fn every_direction_has_a_sector() {
        for (x, y) in [(0.0, 0.0), (1.0, -1e-18), (-5.0, 0.0), (1e9, 1e9), (0.0, -60.0)] {
            assert!(sector_of(x, y) < RINGS.len() * SECTORS);
        }
    }
}
