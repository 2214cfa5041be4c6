//! RANSAC for one ground plane, seeded, so that a run repeats itself bit for bit.

use super::chosen::{BLOCK, extend_where, places_where};
use super::plane::{Plane, PlaneSums};
use crate::config::GroundConfig;
use crate::space::{Point, Vector};
use rand::RngExt;
use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use std::cmp::Reverse;

/// Hypotheses that are scored.
const HYPOTHESES: usize = 300;
/// Triples drawn at most: most are too steep or too far away to be scored.
const DRAWS: usize = 8 * HYPOTHESES;
/// Points that a hypothesis is scored on at first.
const FIRST_LOOK: usize = 1024;
/// Hypotheses that are scored on all points.
const FINALISTS: usize = 16;

/// A plane, and how many points lie on it.
type Scored = (usize, Plane);

/// The points that can lie on an admissible plane, each coordinate apart.
pub(super) struct Candidates {
    xs: Vec<f32>,
    ys: Vec<f32>,
    zs: Vec<f32>,
}

impl Candidates {
    /// Leaves out what no admissible plane reaches: its height at a horizontal distance `rho` from the vehicle is at
    /// most `max_offset / cos(max_tilt) + rho tan(max_tilt)`. Points that are not finite fail the comparison and leave,
    /// too.
    pub(super) fn admissible(points: &[[f32; 3]], config: &GroundConfig) -> Self {
        let tilt = config.max_tilt_deg.to_radians();
        let reach = ((config.max_offset + config.inlier_distance) / tilt.cos()) as f32;
        let slope = tilt.tan() as f32;
        let is_admissible = |[x, y, z]: &[f32; 3]| {
            let rho = (x * x + y * y).sqrt();
            z.abs() <= reach + slope * rho
        };
        let mut columns = [(); 3].map(|()| Vec::with_capacity(points.len()));
        points.chunks(BLOCK).for_each(|block| extend_where(&mut columns, block, is_admissible));
        let [xs, ys, zs] = columns;
        Self { xs, ys, zs }
    }

    pub(super) fn len(&self) -> usize {
        self.xs.len()
    }

    pub(super) fn point(&self, i: usize) -> Vector {
        Vector::new(self.xs[i].into(), self.ys[i].into(), self.zs[i].into())
    }

    /// Every n-th point, so that at most [`FIRST_LOOK`] are left.
    fn thinned(&self) -> Self {
        let step = self.len().div_ceil(FIRST_LOOK).max(1);
        let thin = |values: &[f32]| values.iter().copied().step_by(step).collect();
        Self { xs: thin(&self.xs), ys: thin(&self.ys), zs: thin(&self.zs) }
    }

    /// A plane and how many points lie within `inlier_distance` of it; `None` as soon as it is told that they are fewer
    /// than the least number.
    fn scored_if_at_least(&self, least: usize, plane: Plane, config: &GroundConfig) -> Option<Scored> {
        let mut inliers = 0;
        let mut left = self.len();
        for (xs, ys, zs) in self.blocks() {
            inliers += count_inliers((xs, ys, zs), &plane, config.inlier_distance);
            left -= xs.len();
            if inliers + left < least {
                return None;
            }
        }
        Some((inliers, plane))
    }

    /// What a plane gives way to, which is the one that is fitted to its points while that has more of them; and what
    /// is fitted to the points of the last.
    fn climbed(&self, mut best: Scored, config: &GroundConfig) -> (Scored, Option<Plane>) {
        let mut refitted = self.refitted(&best.1, config);
        for _ in 0..config.climbs {
            let higher = |plane| self.scored_if_at_least(best.0 + 1, plane, config);
            let Some(found) = refitted.and_then(higher) else { break };
            best = found;
            refitted = self.refitted(&best.1, config);
        }
        (best, refitted)
    }

    /// The admissible plane of orthogonal least squares through the points within `inlier_distance` of a plane.
    fn refitted(&self, plane: &Plane, config: &GroundConfig) -> Option<Plane> {
        let mut sums = PlaneSums::default();
        let mut room = [0; BLOCK];
        for (xs, ys, zs) in self.blocks() {
            let point = |x: &f32, y: &f32, z: &f32| Vector::new((*x).into(), (*y).into(), (*z).into());
            let points = xs.iter().zip(ys).zip(zs).map(|((x, y), z)| point(x, y, z));
            let is_inlier = |p| plane.height(&Point::from(p)).abs() <= config.inlier_distance;
            for place in places_where(&mut room, points.map(is_inlier)) {
                let place = *place as usize;
                sums = sums.with(point(&xs[place], &ys[place], &zs[place]));
            }
        }
        sums.plane().filter(|plane| plane.is_admissible(config))
    }

    /// Coordinates of points that are looked at together.
    fn blocks(&self) -> impl Iterator<Item = (&[f32], &[f32], &[f32])> {
        let blocks = self.xs.chunks(BLOCK).zip(self.ys.chunks(BLOCK)).zip(self.zs.chunks(BLOCK));
        blocks.map(|((xs, ys), zs)| (xs, ys, zs))
    }
}

/// How many points of a block lie within `distance` of a plane.
fn count_inliers((xs, ys, zs): (&[f32], &[f32], &[f32]), plane: &Plane, distance: f64) -> usize {
    let [nx, ny, nz] = [plane.normal.x as f32, plane.normal.y as f32, plane.normal.z as f32];
    let (offset, distance) = (plane.offset as f32, distance as f32);
    let points = xs.iter().zip(ys).zip(zs);
    points.map(|((x, y), z)| u32::from((nx * x + ny * y + nz * z - offset).abs() <= distance)).sum::<u32>()
        as usize
}

/// The admissible plane with the most points within `inlier_distance`, refitted once on these.
///
/// Hypotheses are scored on a part of the points, and the best of them on all. They climb there, and the winner among
/// all: as long as the plane fitted to its points has more of them, that one takes its place, so that little depends on
/// the seed; so many times at most as `ground.climbs` has it, 0 being the paper's.
pub(super) fn fit(candidates: &Candidates, config: &GroundConfig, seed: u64) -> Option<Plane> {
    // The first of equally good ones, whatever their number.
    let mut best: Option<Scored> = None;
    for plane in finalists(candidates, config, seed) {
        let least = best.map_or(0, |(inliers, _)| inliers + 1);
        best = candidates.scored_if_at_least(least, plane, config).or(best);
    }
    let ((_, best), refitted) = candidates.climbed(best?, config);
    Some(refitted.unwrap_or(best))
}

/// The hypotheses with the most inliers among a part of the points, the best first, of equally good ones the one drawn
/// first.
fn finalists(candidates: &Candidates, config: &GroundConfig, seed: u64) -> impl Iterator<Item = Plane> {
    let first_look = candidates.thinned();
    let mut ranked: Vec<Scored> = Vec::with_capacity(FINALISTS + 1);
    for plane in draw(candidates, config, seed) {
        let least = ranked.get(FINALISTS - 1).map_or(0, |(inliers, _)| inliers + 1);
        let Some(scored) = first_look.scored_if_at_least(least, plane, config) else { continue };
        let place = ranked.partition_point(|(better, _)| *better >= scored.0);
        ranked.insert(place, scored);
        ranked.truncate(FINALISTS);
    }
    ranked.iter_mut().for_each(|scored| *scored = first_look.climbed(*scored, config).0);
    ranked.sort_by_key(|(inliers, _)| Reverse(*inliers));
    ranked.into_iter().map(|(_, plane)| plane)
}

/// Admissible planes through three random points each.
fn draw(candidates: &Candidates, config: &GroundConfig, seed: u64) -> Vec<Plane> {
    if candidates.len() < 3 {
        return Vec::new();
    }
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut triple =
        || [(); 3].map(|()| candidates.point(random.random_range(0..candidates.len() as u32) as usize));
    let planes = (0..DRAWS).filter_map(|_| {
        let [a, b, c] = triple();
        Plane::through(&Point::from(a), (b - a).cross(&(c - a))).filter(|plane| plane.is_admissible(config))
    });
    planes.take(HYPOTHESES).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A street: ground tilted by `slope` along y, two walls, a flat roof above.
    fn street(slope: f32) -> Vec<[f32; 3]> {
        let mut points = Vec::new();
        for i in 0..60 {
            for j in -30..30 {
                let (x, y) = (i as f32 - 20.0, j as f32 * 0.5);
                let ripple = ((i * 7 + j * 13) % 5) as f32 * 0.01;
                points.push([x, y, slope * y + ripple]);
                points.push([x, 16.0, (i + j + 30) as f32 * 0.05]);
                points.push([x, y, 4.0]);
            }
        }
        points.push([f32::NAN, 0.0, 0.0]);
        points
    }

    #[test]
    fn finds_the_tilted_street_below_a_larger_roof() {
        let config = GroundConfig::default();
        for seed in 0..20 {
            let points = street(0.05);
            let plane = fit(&Candidates::admissible(&points, &config), &config, seed).unwrap();
            assert!((plane.normal.y + 0.05).abs() < 0.005, "seed {seed}: {plane:?}");
            assert!(plane.height(&Point::new(10.0, 10.0, 0.5)).abs() < 0.05);
        }
    }

    #[test]
    fn little_depends_on_the_seed() {
        let config = GroundConfig::default();
        let candidates = Candidates::admissible(&street(0.03), &config);
        let planes: Vec<_> = (0..10).map(|seed| fit(&candidates, &config, seed).unwrap()).collect();
        for plane in &planes {
            let corner = Point::new(40.0, 15.0, 0.0);
            assert!((plane.height(&corner) - planes[0].height(&corner)).abs() < 0.01, "{planes:?}");
        }
    }

    /// A rough meadow: without climbing the plane that was drawn is refitted once, as the paper's, and more depends on
    /// what was drawn.
    #[test]
    fn without_climbing_more_depends_on_the_seed() {
        let places = (0..1000).map(|i| ((i % 40) as f32, (i / 40) as f32 - 12.0, (i * i % 101) as f32));
        let meadow: Vec<[f32; 3]> = places.map(|(x, y, rough)| [x, y, 0.006 * rough - 0.3]).collect();
        let spread = |climbs| {
            let config = GroundConfig { climbs, ..GroundConfig::default() };
            let candidates = Candidates::admissible(&meadow, &config);
            let corner = Point::new(40.0, 15.0, 0.0);
            let heights = (0..10).map(|seed| fit(&candidates, &config, seed).unwrap().height(&corner));
            let (least, most) =
                heights.fold((f64::MAX, f64::MIN), |(least, most), at| (at.min(least), at.max(most)));
            most - least
        };
        assert!(spread(0) > spread(8), "{} {}", spread(0), spread(8));
    }

    #[test]
    fn the_same_seed_gives_the_same_bits() {
        let config = GroundConfig::default();
        let candidates = Candidates::admissible(&street(0.02), &config);
        assert_eq!(fit(&candidates, &config, 3), fit(&candidates, &config, 3));
    }

    #[test]
    fn nothing_admissible_is_no_ground() {
        let config = GroundConfig::default();
        let roof: Vec<_> = (0..100).map(|i| [(i % 10) as f32, (i / 10) as f32, 4.0]).collect();
        assert!(fit(&Candidates::admissible(&roof, &config), &config, 0).is_none());
        assert!(fit(&Candidates::admissible(&[], &config), &config, 0).is_none());
    }
}
