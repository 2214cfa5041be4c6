//! Counting where rays end: some at a time, side by side.

use super::super::probe::Probe;
use crate::scene::{Cone, TableRay};
use nalgebra::{Matrix3, RowVector3, Vector3};
use std::cell::OnceCell;
use std::f32::consts::TAU;
use wide::{f32x4, f32x8};

/// Rays within so many standard deviations of a detection's direction vote.
pub(super) const CONE_SIGMAS: f32 = 2.5;
/// A ray that ends lower than this above the ground ends on it, m.
const GROUND_BAND: f32 = 0.2;
/// No Mahalanobis distance is larger.
pub(super) const LARGEST_CHI: f32 = 10.0;
/// Rays that are counted together.
pub(super) const LANES: usize = 8;
/// So far away and so high nothing counts.
const NOWHERE: f32 = 1e9;
/// What counts nowhere.
pub(super) const NO_RAY: TableRay =
    TableRay { azimuth: 0.0, elevation: NOWHERE, range: 0.0, id: u32::MAX, point: [NOWHERE; 3] };

/// A detection as seen from the LiDAR.
pub(super) struct Target<'a> {
    pub(super) position: Vector3<f32>,
    pub(super) range: f32,
    pub(super) cone: Cone,
    /// A ray ends in it within this, m.
    pub(super) depth: f32,
    /// A ray that ends nearer to the LiDAR or farther from it by more than this, m, along the detection's own ray, ends
    /// outside of it, and no less than [`LARGEST_CHI`] away.
    pub(super) reach: f32,
    /// A ray of the cone goes at least this share of its length along the detection's own ray.
    pub(super) least_cosine: f32,
    /// `(Sigma + (0.1 m)^2 I)^-1`, worked out where it is first asked for.
    pub(super) precision: Precision<'a>,
    /// A point's height above the ground is this times it ...
    pub(super) up: RowVector3<f32>,
    /// ... and this, m.
    pub(super) origin_height: f32,
}

/// `(Sigma + (0.1 m)^2 I)^-1` of a detection in the LiDAR's frame: few rays end so near that it is asked for.
pub(super) struct Precision<'a> {
    pub(super) probe: &'a Probe,
    pub(super) window_from_lidar: Matrix3<f32>,
    pub(super) in_lidar: OnceCell<Matrix3<f32>>,
}

impl Precision<'_> {
    fn in_lidar(&self) -> &Matrix3<f32> {
        let turn = &self.window_from_lidar;
        self.in_lidar.get_or_init(|| turn.tr_mul(&self.probe.precision().cast()) * turn)
    }
}

impl Target<'_> {
    /// By how much rays of these ranges end beyond it, m, and which of them surely end far from it.
    #[inline]
    fn past(&self, ranges: f32x8) -> (f32x8, f32x8) {
        let (range, reach) = (f32x8::splat(self.range), f32x8::splat(self.reach));
        let past = ranges - range;
        let is_beyond = (ranges * f32x8::splat(self.least_cosine) - range).simd_gt(reach);
        (past, past.simd_lt(-reach) | is_beyond)
    }
}

/// Directions and ranges of a few rays, each number apart.
struct Few {
    azimuth: f32x8,
    elevation: f32x8,
    range: f32x8,
}

/// Where a few rays end, each number apart.
struct Ends {
    x: f32x8,
    y: f32x8,
    z: f32x8,
}

/// Sums over the rays towards a detection.
pub(super) struct Tally {
    inside: f32x8,
    ground: f32x8,
    beyond: f32x8,
    before: f32x8,
    least: f32x8,
}

impl Tally {
    pub(super) fn new() -> Self {
        let none = f32x8::ZERO;
        let least = f32x8::splat(LARGEST_CHI * LARGEST_CHI);
        Self { inside: none, ground: none, beyond: none, before: none, least }
    }

    /// The weights of the rays that end in the detection, on the ground there, beyond and before it, and the least
    /// Mahalanobis distance of the detection from a ray's end, with `Sigma + (0.1 m)^2 I`.
    pub(super) fn finish(self) -> ([f64; 4], f64) {
        let sum = |lanes: f32x8| f64::from(lanes.to_array().iter().sum::<f32>());
        let least = self.least.to_array().into_iter().fold(f32::INFINITY, f32::min);
        let sums = [self.inside, self.ground, self.beyond, self.before].map(sum);
        (sums, f64::from(least.max(0.0).sqrt()))
    }

    /// Counts some rays of the target's cone.
    #[inline]
    pub(super) fn count(&mut self, target: &Target, rays: &[&TableRay; LANES]) {
        let few = Few::of(rays);
        let weights = few.weights(&target.cone);
        let (past, is_far) = target.past(few.range);
        let depth = f32x8::splat(target.depth);
        self.beyond += past.simd_ge(depth) & weights;
        self.before += past.simd_le(-depth) & weights;
        if !is_far.all() {
            self.count_near(target, &Ends::of(rays), past, weights);
        }
    }

    /// What only rays can change that end near the detection.
    #[inline(never)]
    fn count_near(&mut self, target: &Target, ends: &Ends, past: f32x8, weights: f32x8) {
        let (squares, heights) = (ends.squared_distances(target), ends.heights(target));
        let depth = f32x8::splat(target.depth);
        let elsewhere = past.simd_ge(depth) | past.simd_le(-depth);
        let there = elsewhere.bitselect(f32x8::ZERO, weights);
        let low = heights.simd_lt(f32x8::splat(GROUND_BAND));
        self.inside += low.bitselect(f32x8::ZERO, there);
        self.ground += low & there;
        self.least = squares.simd_lt(self.least).bitselect(squares, self.least);
    }
}

impl Few {
    #[inline]
    fn of([a, b, c, d, e, f, g, h]: &[&TableRay; LANES]) -> Self {
        let [first, second] = [[a, b, c, d], [e, f, g, h]].map(numbers_of);
        let both = |number: usize| bytemuck::cast([first[number], second[number]]);
        Self { azimuth: both(0), elevation: both(1), range: both(2) }
    }

    /// A Gaussian of the way from the cone's middle, whose borders lie at 2.5 sigmas; 0 outside.
    #[inline]
    fn weights(&self, cone: &Cone) -> f32x8 {
        let [per_azimuth, per_elevation] =
            [cone.half_azimuth, cone.half_elevation].map(|half| f32x8::splat(half.recip()));
        let beside = (self.azimuth - f32x8::splat(cone.azimuth)).abs();
        let around = f32x8::splat(TAU) - beside;
        let beside = around.fast_min(beside) * per_azimuth;
        let above = (self.elevation - f32x8::splat(cone.elevation)).abs() * per_elevation;
        let exponent = (beside * beside + above * above) * f32x8::splat(CONE_SIGMAS * CONE_SIGMAS / 2.0);
        // exp(-x) as (1 - x / 64)^64: six products, and a third off at most, in the corners, where it is 0.002.
        let mut weight = f32x8::ONE - exponent * f32x8::splat(1.0 / 64.0);
        for _ in 0..6 {
            weight *= weight;
        }
        (beside.simd_gt(f32x8::ONE) | above.simd_gt(f32x8::ONE)).bitselect(f32x8::ZERO, weight)
    }
}

/// Azimuth, elevation and range of four rays, each number apart, and their identities.
#[inline]
fn numbers_of([a, b, c, d]: [&&TableRay; 4]) -> [f32x4; 4] {
    f32x4::transpose([vector_of(a), vector_of(b), vector_of(c), vector_of(d)])
}

#[inline]
fn vector_of(ray: &TableRay) -> f32x4 {
    f32x4::new([ray.azimuth, ray.elevation, ray.range, f32::from_bits(ray.id)])
}

impl Ends {
    fn of(rays: &[&TableRay; LANES]) -> Self {
        let [x, y, z] = [0, 1, 2].map(|axis| f32x8::new(rays.map(|ray| ray.point[axis])));
        Self { x, y, z }
    }

    /// Mahalanobis distances of the detection from the rays' ends, squared.
    fn squared_distances(&self, target: &Target) -> f32x8 {
        let (p, m) = (&target.position, target.precision.in_lidar());
        let [x, y, z] = [self.x - f32x8::splat(p.x), self.y - f32x8::splat(p.y), self.z - f32x8::splat(p.z)];
        let along = |row: usize| {
            let [by_x, by_y, by_z] = [0, 1, 2].map(|column| f32x8::splat(m[(row, column)]));
            by_x * x + by_y * y + by_z * z
        };
        x * along(0) + y * along(1) + z * along(2)
    }

    /// Heights of the rays' ends above the ground below the detection, m.
    fn heights(&self, target: &Target) -> f32x8 {
        let [x, y, z] = [target.up.x, target.up.y, target.up.z].map(f32x8::splat);
        x * self.x + y * self.y + z * self.z + f32x8::splat(target.origin_height)
    }
}
