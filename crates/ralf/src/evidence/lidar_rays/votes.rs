//! The votes of one LiDAR scan on one detection.

use super::super::probe::{Probe, SAME_SPOT};
use crate::scene::{Cone, LidarSweep, RayTable, TableRay, direction_of};
use crate::space::Transform;
use nalgebra::{Isometry3, Matrix3, RowVector3, Vector3};

/// Rays within so many standard deviations of a detection's direction vote.
const CONE_SIGMAS: f32 = 2.5;
/// The cone reaches at least so far to each side, rad.
const LEAST_CONE: f32 = 0.7 * std::f32::consts::PI / 180.0;
/// And at most so far: nearer than some metres a height alone would fill the sky.
const LARGEST_CONE: f32 = 0.35;
/// A ray ends in a detection within so many standard deviations of its range.
const RANGE_SIGMAS: f32 = 3.0;
/// A ray that ends lower than this above the ground ends on it, m.
const GROUND_BAND: f32 = 0.2;
/// No Mahalanobis distance is larger.
const LARGEST_CHI: f32 = 10.0;

/// Weights of the rays towards a detection by where they end, and the distance from their points.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Votes {
    pub(super) inside: f64,
    pub(super) ground: f64,
    pub(super) beyond: f64,
    pub(super) before: f64,
    /// Least Mahalanobis distance of the detection from a point, with `Sigma + (0.1 m)^2 I`; `None` without any ray.
    pub(super) chi: Option<f64>,
}

impl Votes {
    pub(super) fn total(&self) -> f64 {
        self.inside + self.ground + self.beyond + self.before
    }

    /// A weight's part of all; `None` without any ray.
    pub(super) fn share(&self, weight: f64) -> Option<f64> {
        let total = self.total();
        (total > 0.0).then(|| weight / total)
    }

    pub(super) fn add(&mut self, other: &Self) {
        self.inside += other.inside;
        self.ground += other.ground;
        self.beyond += other.beyond;
        self.before += other.before;
        self.chi = match (self.chi, other.chi) {
            (Some(a), Some(b)) => Some(a.min(b)),
            (a, b) => a.or(b),
        };
    }
}

/// One LiDAR's scan, ready to be asked.
pub(super) struct Sweep<'a> {
    table: &'a RayTable,
    lidar_from_window: Isometry3<f32>,
    window_from_lidar: Matrix3<f64>,
    /// Where the LiDAR is in the window's frame, m.
    origin: Vector3<f64>,
    sigma_range: f64,
    /// About how many rays are looked at.
    rays: usize,
}

/// A detection as seen from the LiDAR.
struct Target {
    position: Vector3<f32>,
    range: f32,
    cone: Cone,
    /// A ray ends in it within this, m.
    depth: f32,
    /// `(Sigma + (0.1 m)^2 I)^-1`.
    precision: Matrix3<f32>,
    /// A point's height above the ground is this times it ...
    up: RowVector3<f32>,
    /// ... and this, m.
    origin_height: f32,
}

impl<'a> Sweep<'a> {
    pub(super) fn new(sweep: &'a LidarSweep, window_from_lidar: Transform, rays: usize) -> Self {
        Self {
            table: sweep.rays(),
            lidar_from_window: window_from_lidar.inverse().cast(),
            window_from_lidar: window_from_lidar.rotation.to_rotation_matrix().into_inner(),
            origin: window_from_lidar.translation.vector,
            sigma_range: sweep.sigma_range,
            rays,
        }
    }

    /// Where the rays towards a detection end.
    pub(super) fn vote(&self, probe: &Probe) -> Votes {
        let Some(target) = self.target(probe) else { return Votes::default() };
        let towards: usize = self.table.runs(&target.cone).map(|run| run.len()).sum();
        let step = towards.div_ceil(self.rays).max(1);
        let mut sums = [0.0f32; 4];
        let mut least = LARGEST_CHI * LARGEST_CHI;
        let mut skip = 0;
        for run in self.table.runs(&target.cone) {
            let end = run.end;
            let mut place = run.start + skip;
            while place < end {
                let ray = &self.table.rays()[place];
                let h = Vector3::from(ray.point) - target.position;
                least = least.min(h.dot(&(target.precision * h)));
                sums[target.ending(ray)] += target.cone.weight(ray);
                place += step;
            }
            skip = place - end;
        }
        let [inside, ground, beyond, before] = sums.map(|sum| f64::from(sum) * step as f64);
        let chi = (towards > 0).then(|| f64::from(least.max(0.0).sqrt()));
        Votes { inside, ground, beyond, before, chi }
    }

    /// `None` where the detection lies in the LiDAR itself.
    fn target(&self, probe: &Probe) -> Option<Target> {
        let detection = &probe.detection;
        let position = self.lidar_from_window * detection.position.cast::<f32>();
        let (azimuth, elevation, range) = direction_of(position.x, position.y, position.z);
        let towards = detection.position.coords - self.origin;
        let ray = towards.try_normalize(1e-3)?;
        let zenith = self.window_from_lidar.column(2);
        let aside = zenith.cross(&ray);
        // Of the way to the detection so much lies across the LiDAR's axis.
        let across = aside.norm().max(1e-6);
        let aside = aside / across;
        let angle = |sigma: f64, radius: f64| {
            (CONE_SIGMAS * (sigma / radius.max(1e-3)) as f32).clamp(LEAST_CONE, LARGEST_CONE)
        };
        let distance = towards.norm();
        let half_azimuth = angle(detection.sigma_along(&aside), distance * across);
        let half_elevation = angle(detection.sigma_along(&ray.cross(&aside)), distance);
        let spread = detection.sigma_along(&ray).hypot(self.sigma_range).hypot(SAME_SPOT);
        let rotation = self.window_from_lidar;
        Some(Target {
            position: position.coords,
            range,
            cone: Cone { azimuth, elevation, half_azimuth, half_elevation },
            depth: RANGE_SIGMAS * spread as f32,
            precision: (rotation.transpose() * probe.precision * rotation).cast(),
            up: rotation.row(2).into_owned().cast(),
            origin_height: (self.origin.z - probe.ground) as f32,
        })
    }
}

impl Target {
    /// 0 where a ray ends in the detection, 1 on the ground there, 2 beyond, 3 before.
    fn ending(&self, ray: &TableRay) -> usize {
        let past = ray.range - self.range;
        if past >= self.depth {
            return 2;
        }
        if past <= -self.depth {
            return 3;
        }
        let height = (self.up * Vector3::from(ray.point)).x + self.origin_height;
        usize::from(height < GROUND_BAND)
    }
}

impl Cone {
    /// A Gaussian of the way from the cone's middle, whose borders lie at 2.5 sigmas; 0 outside.
    fn weight(&self, ray: &TableRay) -> f32 {
        let beside = (ray.azimuth - self.azimuth).abs();
        let beside = beside.min(std::f32::consts::TAU - beside) / self.half_azimuth;
        let above = (ray.elevation - self.elevation).abs() / self.half_elevation;
        if beside > 1.0 || above > 1.0 {
            return 0.0;
        }
        let exponent = (beside * beside + above * above) * (CONE_SIGMAS * CONE_SIGMAS / 2.0);
        // exp(-x) as (1 - x / 64)^64: six products, and a third off at most, in the corners, where it is 0.002.
        let mut weight = 1.0 - exponent / 64.0;
        for _ in 0..6 {
            weight *= weight;
        }
        weight
    }
}
