//! The votes of one LiDAR scan on one detection.

use super::super::probe::{Probe, SAME_SPOT};
use super::tally::{CONE_SIGMAS, LANES, LARGEST_CHI, NO_RAY, Precision, Tally, Target};
use crate::scene::{Cone, LidarSweep, RayTable, direction_of};
use crate::space::Transform;
use nalgebra::{Isometry3, Matrix3, Vector3};
use std::cell::OnceCell;
use std::ops::Range;

/// The cone reaches at least so far to each side, rad.
const LEAST_CONE: f32 = 0.7 * std::f32::consts::PI / 180.0;
/// And at most so far: nearer than some metres a height alone would fill the sky.
const LARGEST_CONE: f32 = 0.35;
/// A ray ends in a detection within so many standard deviations of its range.
const RANGE_SIGMAS: f32 = 3.0;
/// What is surely farther than this share of a distance is farther than the distance, however sums are rounded.
const ROUNDING: f32 = 1.05;

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
    /// The same.
    rotation: Matrix3<f32>,
    /// Where the LiDAR is in the window's frame, m.
    origin: Vector3<f64>,
    sigma_range: f64,
    /// About how many rays are looked at.
    rays: usize,
    /// Stretches of the table that the last cone touched.
    runs: Vec<Range<usize>>,
    /// Places in the table of the rays of these that are looked at, with room for a few more.
    places: Vec<u32>,
}

impl<'a> Sweep<'a> {
    pub(super) fn new(sweep: &'a LidarSweep, window_from_lidar: Transform, rays: usize) -> Self {
        let rotation = window_from_lidar.rotation.to_rotation_matrix().into_inner();
        Self {
            table: sweep.rays(),
            lidar_from_window: window_from_lidar.inverse().cast(),
            window_from_lidar: rotation,
            rotation: rotation.cast(),
            origin: window_from_lidar.translation.vector,
            sigma_range: sweep.sigma_range,
            rays,
            runs: Vec::new(),
            places: vec![0; rays.next_multiple_of(LANES) + LANES],
        }
    }

    /// Where the rays towards a detection end.
    pub(super) fn vote(&mut self, probe: &Probe) -> Votes {
        let Some(target) = self.target(probe) else { return Votes::default() };
        self.table.runs(&target.cone, &mut self.runs);
        let towards: usize = self.runs.iter().map(Range::len).sum();
        if towards == 0 {
            return Votes::default();
        }
        let step = towards.div_ceil(self.rays);
        let mut tally = Tally::new();
        let rays = self.table.rays();
        for places in self.take_every(step as u32) {
            let mut few = [&NO_RAY; LANES];
            for (ray, place) in few.iter_mut().zip(places) {
                *ray = rays.get(*place as usize).unwrap_or(&NO_RAY);
            }
            tally.count(&target, &few);
        }
        let (sums, chi) = tally.finish();
        let [inside, ground, beyond, before] = sums.map(|sum| sum * step as f64);
        Votes { inside, ground, beyond, before, chi: Some(chi) }
    }

    /// The places in the table of every so many rays of the stretches, counted through from the first one, of which
    /// there are no more than wanted; what fills up the last few is none.
    fn take_every(&mut self, step: u32) -> &[[u32; LANES]] {
        let (mut passed, mut taken) = (0, 0);
        for run in &self.runs {
            let (begin, end) = (run.start as u32, passed + run.len() as u32);
            let next = end.div_ceil(step);
            let mut place = begin + taken * step - passed;
            // More than there are, which the next ones overwrite: how many there are is hard to foretell.
            while let Some(places) = self.places[taken as usize..].first_chunk_mut::<LANES>() {
                for next in places {
                    *next = place;
                    place += step;
                }
                taken += LANES as u32;
                if taken >= next {
                    break;
                }
            }
            (passed, taken) = (end, next);
        }
        if let Some(places) = self.places[taken as usize..].first_chunk_mut() {
            *places = [u32::MAX; LANES];
        }
        &self.places.as_chunks().0[..(taken as usize).div_ceil(LANES)]
    }

    /// The place in the scan of a ray towards a detection.
    pub(super) fn towards(&mut self, probe: &Probe) -> Option<u32> {
        let target = self.target(probe)?;
        self.table.runs(&target.cone, &mut self.runs);
        self.runs.first().map(|run| self.table.rays()[run.start.midpoint(run.end)].id)
    }

    /// `None` where the detection lies in the LiDAR itself.
    fn target<'p>(&self, probe: &'p Probe) -> Option<Target<'p>> {
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
        let along = detection.sigma_along(&ray);
        let own = along * along + SAME_SPOT * SAME_SPOT;
        let spread = (along * along + self.sigma_range * self.sigma_range + SAME_SPOT * SAME_SPOT).sqrt();
        let depth = RANGE_SIGMAS * spread as f32;
        // Of a way `h` that leads so far along a direction `u`, h^T S^-1 h is at least (h u)^2 / (u^T S u).
        let reach = depth.max(ROUNDING * LARGEST_CHI * own.sqrt() as f32);
        let [beside, above] = [half_azimuth, half_elevation].map(|half| half + RayTable::BESIDE);
        Some(Target {
            position: position.coords,
            range,
            cone: Cone { azimuth, elevation, half_azimuth, half_elevation },
            depth,
            reach,
            // cos x is at least 1 - x^2 / 2.
            least_cosine: 1.0 - ROUNDING * 0.5 * (beside * beside + above * above),
            precision: Precision { probe, window_from_lidar: self.rotation, in_lidar: OnceCell::new() },
            up: self.rotation.row(2).into_owned(),
            origin_height: (self.origin.z - probe.ground) as f32,
        })
    }
}
