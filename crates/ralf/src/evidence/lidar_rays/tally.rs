//! Counting where rays end: some at a time, so that the compiler makes vector instructions of it.

use crate::scene::{Cone, TableRay};
use nalgebra::{Matrix3, RowVector3, Vector3};
use std::cell::OnceCell;
use std::f32::consts::TAU;

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
    TableRay { azimuth: 0.0, elevation: NOWHERE, range: 0.0, point: [NOWHERE; 3], id: u32::MAX };

/// A detection as seen from the LiDAR.
pub(super) struct Target {
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
    pub(super) precision: Precision,
    /// A point's height above the ground is this times it ...
    pub(super) up: RowVector3<f32>,
    /// ... and this, m.
    pub(super) origin_height: f32,
}

/// `(Sigma + (0.1 m)^2 I)^-1` of a detection in the LiDAR's frame: few rays end so near that it is asked for.
pub(super) struct Precision {
    /// In the window's frame.
    pub(super) in_window: Matrix3<f64>,
    pub(super) window_from_lidar: Matrix3<f32>,
    pub(super) in_lidar: OnceCell<Matrix3<f32>>,
}

impl Precision {
    fn in_lidar(&self) -> &Matrix3<f32> {
        let turn = &self.window_from_lidar;
        self.in_lidar.get_or_init(|| turn.tr_mul(&self.in_window.cast()) * turn)
    }
}

impl Target {
    /// By how much a ray of this range ends beyond it, m, and whether it surely ends far from it.
    fn past(&self, range: f32) -> (f32, bool) {
        let past = range - self.range;
        (past, (past < -self.reach) | (range * self.least_cosine - self.range > self.reach))
    }
}

/// Directions and ranges of a few rays, each number apart.
struct Few {
    azimuth: [f32; LANES],
    elevation: [f32; LANES],
    range: [f32; LANES],
}

/// Where a few rays end, each number apart.
struct Ends {
    x: [f32; LANES],
    y: [f32; LANES],
    z: [f32; LANES],
}

/// Sums over the rays towards a detection.
pub(super) struct Tally {
    inside: [f32; LANES],
    ground: [f32; LANES],
    beyond: [f32; LANES],
    before: [f32; LANES],
    least: [f32; LANES],
}

impl Tally {
    pub(super) fn new() -> Self {
        let none = [0.0; LANES];
        let least = [LARGEST_CHI * LARGEST_CHI; LANES];
        Self { inside: none, ground: none, beyond: none, before: none, least }
    }

    /// The weights of the rays that end in the detection, on the ground there, beyond and before it, and the least
    /// Mahalanobis distance of the detection from a ray's end, with `Sigma + (0.1 m)^2 I`.
    pub(super) fn finish(self) -> ([f64; 4], f64) {
        let sum = |lanes: [f32; LANES]| f64::from(lanes.iter().sum::<f32>());
        let least = self.least.into_iter().fold(f32::INFINITY, f32::min);
        let sums = [self.inside, self.ground, self.beyond, self.before].map(sum);
        (sums, f64::from(least.max(0.0).sqrt()))
    }

    /// Counts some rays of the target's cone.
    pub(super) fn count(&mut self, target: &Target, rays: &[&TableRay; LANES]) {
        let few = Few::of(rays);
        let weights = few.weights(&target.cone);
        let mut past = [0.0; LANES];
        let mut near = false;
        for lane in 0..LANES {
            let is_far;
            (past[lane], is_far) = target.past(few.range[lane]);
            near |= !is_far;
            self.beyond[lane] += if past[lane] >= target.depth { weights[lane] } else { 0.0 };
            self.before[lane] += if past[lane] <= -target.depth { weights[lane] } else { 0.0 };
        }
        if near {
            self.count_near(target, &Ends::of(rays), &past, &weights);
        }
    }

    /// What only rays can change that end near the detection.
    fn count_near(&mut self, target: &Target, ends: &Ends, past: &[f32; LANES], weights: &[f32; LANES]) {
        let squares = ends.squared_distances(target);
        let heights = ends.heights(target);
        for lane in 0..LANES {
            let there = !((past[lane] >= target.depth) | (past[lane] <= -target.depth));
            let low = heights[lane] < GROUND_BAND;
            self.inside[lane] += if there & !low { weights[lane] } else { 0.0 };
            self.ground[lane] += if there & low { weights[lane] } else { 0.0 };
            self.least[lane] =
                if squares[lane] < self.least[lane] { squares[lane] } else { self.least[lane] };
        }
    }
}

impl Few {
    fn of(rays: &[&TableRay; LANES]) -> Self {
        Self {
            azimuth: rays.map(|ray| ray.azimuth),
            elevation: rays.map(|ray| ray.elevation),
            range: rays.map(|ray| ray.range),
        }
    }

    /// A Gaussian of the way from the cone's middle, whose borders lie at 2.5 sigmas; 0 outside.
    fn weights(&self, cone: &Cone) -> [f32; LANES] {
        let [per_azimuth, per_elevation] = [cone.half_azimuth, cone.half_elevation].map(f32::recip);
        std::array::from_fn(|lane| {
            let beside = (self.azimuth[lane] - cone.azimuth).abs();
            let around = TAU - beside;
            let beside = if around < beside { around } else { beside } * per_azimuth;
            let above = (self.elevation[lane] - cone.elevation).abs() * per_elevation;
            let exponent = (beside * beside + above * above) * (CONE_SIGMAS * CONE_SIGMAS / 2.0);
            // exp(-x) as (1 - x / 64)^64: six products, and a third off at most, in the corners, where it is 0.002.
            let mut weight = 1.0 - exponent / 64.0;
            for _ in 0..6 {
                weight *= weight;
            }
            if (beside > 1.0) | (above > 1.0) { 0.0 } else { weight }
        })
    }
}

impl Ends {
    fn of(rays: &[&TableRay; LANES]) -> Self {
        Self {
            x: rays.map(|ray| ray.point[0]),
            y: rays.map(|ray| ray.point[1]),
            z: rays.map(|ray| ray.point[2]),
        }
    }

    /// Mahalanobis distances of the detection from the rays' ends, squared.
    fn squared_distances(&self, target: &Target) -> [f32; LANES] {
        let (p, m) = (&target.position, target.precision.in_lidar());
        std::array::from_fn(|lane| {
            let [x, y, z] = [self.x[lane] - p.x, self.y[lane] - p.y, self.z[lane] - p.z];
            x * (m.m11 * x + m.m12 * y + m.m13 * z)
                + y * (m.m21 * x + m.m22 * y + m.m23 * z)
                + z * (m.m31 * x + m.m32 * y + m.m33 * z)
        })
    }

    /// Heights of the rays' ends above the ground below the detection, m.
    fn heights(&self, target: &Target) -> [f32; LANES] {
        let up = &target.up;
        std::array::from_fn(|lane| {
            up.x * self.x[lane] + up.y * self.y[lane] + up.z * self.z[lane] + target.origin_height
        })
    }
}
