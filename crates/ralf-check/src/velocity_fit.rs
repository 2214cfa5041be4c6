//! The velocity of a radar from one scan of its own: what stands still has the range rate `-u . v`.
//!
//! Kellner et al., *Instantaneous ego-motion estimation using Doppler radar*, ITSC 2013: RANSAC over pairs of
//! detections, least squares over the inliers.

use nalgebra::{Matrix2, Vector2};
use ralf::sensors::{Elevation, Radar, RadarScan};
use ralf::space::{Point, Vector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;

/// A detection belongs to the standing world within this and a share of the speed: noise of the range rate, m/s, and
/// what an azimuth that is off by a degree makes of it.
const TOLERANCE: (f64, f64) = (0.15, 0.02);
/// Pairs that are drawn: with 30 % inliers one pair in eleven is good; 80 draws miss all with 0.05 %.
const DRAWS: usize = 80;
/// Below this many detections two unknowns are no finding.
const FEWEST: usize = 8;
/// A velocity is trusted when so large a share of the detections stands still.
pub(crate) const TRUSTED: f64 = 0.3;
/// Rays of a pair are at least this far apart (sine), or their noise is blown up.
const APART: f64 = 0.15;

/// What one scan says of the radar's own velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct VelocityFit {
    /// In the radar's frame, x and y, m/s.
    pub velocity: Vector2<f64>,
    /// Share of the scan's detections that agree, 0 to 1.
    pub inliers: f64,
    /// How many agree.
    pub count: usize,
    /// Of the velocity, (m/s)^2.
    pub covariance: Matrix2<f64>,
    /// Vertical velocity of the radar in its own frame, m/s, by what elevations leave of the inliers' range rates, and
    /// the sum of squared vertical rays that it rests on. 0 where all rays lie in the radar's plane.
    pub vertical: (f64, f64),
}

impl VelocityFit {
    /// Whether a detection of the scan stands still.
    pub(crate) fn agrees(&self, told: &Told) -> bool {
        agrees(&self.velocity, &told.ray, told.range_rate)
    }
}

/// A detection whose direction and range rate are numbers.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Told {
    /// Radar frame, m.
    pub(crate) place: Point,
    /// Unit direction in the radar's frame; in its plane, where it measures no elevation.
    pub(crate) ray: Vector,
    /// m/s.
    pub(crate) range_rate: f64,
}

/// All such detections of a scan, by a field of range rates; none of a radar that lacks it.
pub(crate) fn told(radar: &Radar, scan: &RadarScan, field: &str) -> Vec<Told> {
    let Some(column) = radar.column(field) else { return Vec::new() };
    let of = |(place, rate): (&Point, &f32)| {
        let up = if radar.elevation == Elevation::Measured { place.z } else { 0.0 };
        let ray = Vector::new(place.x, place.y, up).try_normalize(1e-9)?;
        let is_number = ray.norm().is_finite() && rate.is_finite();
        is_number.then_some(Told { place: *place, ray, range_rate: f64::from(*rate) })
    };
    scan.positions.iter().zip(&scan.columns[column]).filter_map(of).collect()
}

/// The velocity that most detections agree with. `rays` are unit directions in the radar's frame, `range_rates` raw
/// (m/s, positive when receding). `None` of scans with fewer than eight detections, and where the rays don't span the
/// plane.
pub fn fit(rays: &[Vector], range_rates: &[f64], seed: u64) -> Option<VelocityFit> {
    if rays.len() < FEWEST || rays.len() != range_rates.len() {
        return None;
    }
    let mut random = Pcg64Mcg::seed_from_u64(seed);
    let mut best: Option<(usize, Vector2<f64>)> = None;
    for _ in 0..DRAWS {
        let pair = [random.random_range(0..rays.len()), random.random_range(0..rays.len())];
        let Some(velocity) = through(pair, rays, range_rates) else { continue };
        let agreeing = (0..rays.len()).filter(|i| agrees(&velocity, &rays[*i], range_rates[*i])).count();
        if best.is_none_or(|(most, _)| agreeing > most) {
            best = Some((agreeing, velocity));
        }
    }
    let (_, first) = best?;
    let refitted = least_squares(&first, rays, range_rates)?;
    let last = least_squares(&refitted.velocity, rays, range_rates)?;
    (last.count >= FEWEST / 2).then_some(last)
}

/// The velocity that two detections share.
fn through(pair: [usize; 2], rays: &[Vector], range_rates: &[f64]) -> Option<Vector2<f64>> {
    let [a, b] = pair.map(|i| rays[i]);
    let determinant = a.x * b.y - a.y * b.x;
    if determinant.abs() < APART {
        return None;
    }
    let [p, q] = pair.map(|i| -range_rates[i]);
    Some(Vector2::new(p * b.y - q * a.y, q * a.x - p * b.x) / determinant)
}

fn residual(velocity: &Vector2<f64>, ray: &Vector, range_rate: f64) -> f64 {
    range_rate + ray.x * velocity.x + ray.y * velocity.y
}

fn agrees(velocity: &Vector2<f64>, ray: &Vector, range_rate: f64) -> bool {
    residual(velocity, ray, range_rate).abs() <= TOLERANCE.0 + TOLERANCE.1 * velocity.norm()
}

/// Least squares over the detections that agree with a velocity.
fn least_squares(about: &Vector2<f64>, rays: &[Vector], range_rates: &[f64]) -> Option<VelocityFit> {
    let inliers: Vec<usize> = (0..rays.len()).filter(|i| agrees(about, &rays[*i], range_rates[*i])).collect();
    let (mut normal, mut right) = (Matrix2::zeros(), Vector2::zeros());
    for i in &inliers {
        let ray = rays[*i].xy();
        normal += ray * ray.transpose();
        right -= ray * range_rates[*i];
    }
    let inverse = normal.try_inverse().filter(|_| inliers.len() > 2)?;
    let velocity = inverse * right;
    let left = inliers.iter().map(|i| (rays[*i], residual(&velocity, &rays[*i], range_rates[*i])));
    let (mut squares, mut vertical, mut weight) = (0.0, 0.0, 0.0);
    for (ray, off) in left {
        squares += off * off;
        vertical -= ray.z * off;
        weight += ray.z * ray.z;
    }
    let variance = squares / (inliers.len() - 2) as f64;
    Some(VelocityFit {
        velocity,
        inliers: inliers.len() as f64 / rays.len() as f64,
        count: inliers.len(),
        covariance: inverse * variance.max(1e-6),
        vertical: (if weight > 0.0 { vertical / weight } else { 0.0 }, weight),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ray(azimuth: f64) -> Vector {
        Vector::new(azimuth.cos(), azimuth.sin(), 0.0)
    }

    #[test]
    fn a_wall_ahead_and_one_to_the_left_tell_both_components() {
        // The radar moves with (5, 1.2): ahead the world comes nearer at 5 m/s, to the left at 1.2 m/s.
        let azimuths: Vec<f64> = (0..10).map(|i| f64::from(i) * 0.17).collect();
        let rays: Vec<Vector> = azimuths.iter().map(|a| ray(*a)).collect();
        let rates: Vec<f64> = azimuths.iter().map(|a| -5.0 * a.cos() - 1.2 * a.sin()).collect();
        let found = fit(&rays, &rates, 0).unwrap();
        assert!((found.velocity - Vector2::new(5.0, 1.2)).norm() < 1e-9);
        assert_eq!(found.inliers, 1.0);
    }

    #[test]
    fn too_few_detections_or_rays_in_one_line_say_nothing() {
        assert!(fit(&[ray(0.0); 7], &[0.0; 7], 0).is_none());
        assert!(fit(&[ray(0.3); 40], &[-1.0; 40], 0).is_none());
    }

    proptest! {
        #[test]
        fn the_standing_world_wins_over_half_as_many_others(
            vx in -30.0..30.0_f64, vy in -10.0..10.0_f64, seed in 0..50_u64
        ) {
            let mut random = Pcg64Mcg::seed_from_u64(seed);
            let rays: Vec<Vector> = (0..90).map(|_| ray(random.random_range(-1.2..1.2))).collect();
            let rates: Vec<f64> = rays.iter().enumerate().map(|(i, u)| {
                if i % 3 == 0 { random.random_range(-40.0..40.0) } else { -u.x * vx - u.y * vy }
            }).collect();
            let found = fit(&rays, &rates, seed).unwrap();
            prop_assert!((found.velocity - Vector2::new(vx, vy)).norm() < 0.2, "{found:?}");
        }
    }
}
