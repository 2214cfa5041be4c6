//! The ground's height: a plane and swells.

use crate::random::Random;
use crate::shape::Ray;
use nalgebra::{Rotation3, UnitQuaternion};
use ralf::space::Vector;
use std::f64::consts::TAU;

/// How often a ray's end is bettered (Newton).
const STEPS: usize = 6;
/// A ray has met the ground where it is so near, m.
const MET: f64 = 0.02;

/// One swell: `height * sin(along . place + phase)`.
#[derive(Debug, Clone, Copy)]
struct Swell {
    height: f64,
    along: [f64; 2],
    phase: f64,
}

/// Heights over the site, m.
#[derive(Debug, Clone, Default)]
pub(super) struct Relief {
    slope: [f64; 2],
    swells: Vec<Swell>,
}

impl Relief {
    /// A plane of these slopes, with swells of (height, length) in m, each in a direction of its own.
    pub(super) fn new(slope: [f64; 2], swells: &[[f64; 2]], random: &mut Random) -> Self {
        let swell = |[height, length]: &[f64; 2]| {
            let (sin, cos) = random.between(0.0, TAU).sin_cos();
            let per_metre = TAU / length;
            Swell {
                height: *height,
                along: [cos * per_metre, sin * per_metre],
                phase: random.between(0.0, TAU),
            }
        };
        Self { slope, swells: swells.iter().map(swell).collect() }
    }

    pub(super) fn height(&self, x: f64, y: f64) -> f64 {
        let phase = |swell: &Swell| swell.along[0] * x + swell.along[1] * y + swell.phase;
        let swells: f64 = self.swells.iter().map(|swell| swell.height * phase(swell).sin()).sum();
        self.slope[0] * x + self.slope[1] * y + swells
    }

    fn gradient(&self, x: f64, y: f64) -> [f64; 2] {
        let mut gradient = self.slope;
        for swell in &self.swells {
            let steep = swell.height * (swell.along[0] * x + swell.along[1] * y + swell.phase).cos();
            gradient[0] += steep * swell.along[0];
            gradient[1] += steep * swell.along[1];
        }
        gradient
    }

    /// How a vehicle that looks along `heading` (rad) stands there.
    pub(super) fn attitude(&self, x: f64, y: f64, heading: f64) -> UnitQuaternion<f64> {
        let [rise_x, rise_y] = self.gradient(x, y);
        let (sin, cos) = heading.sin_cos();
        let ahead = Vector::new(cos, sin, rise_x * cos + rise_y * sin).normalize();
        let up = Vector::new(-rise_x, -rise_y, 1.0).normalize();
        let axes = nalgebra::Matrix3::from_columns(&[ahead, up.cross(&ahead), up]);
        UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(axes))
    }

    /// How far along a ray the ground is, m, if it is nearer than a limit.
    pub(super) fn hit(&self, ray: &Ray, limit: f64) -> Option<f64> {
        let (from, along) = (&ray.origin, &ray.direction);
        if along.z > 0.1 {
            return None;
        }
        let above = from.z - self.height(from.x, from.y);
        let mut distance = if along.z < -4e-3 { above / -along.z } else { 0.8 * limit };
        for _ in 0..STEPS {
            distance = distance.clamp(0.3, 250.0);
            let place = from + along * distance;
            let [rise_x, rise_y] = self.gradient(place.x, place.y);
            let closing = along.z - rise_x * along.x - rise_y * along.y;
            let over = place.z - self.height(place.x, place.y);
            distance -= over / if closing.abs() < 2e-3 { -2e-3 } else { closing };
        }
        let place = from + along * distance;
        let met = (place.z - self.height(place.x, place.y)).abs() < MET;
        (met && distance > 0.3 && distance < limit).then_some(distance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;
    use ralf::space::Point;

    fn hilly() -> Relief {
        Relief::new([0.05, -0.02], &[[0.4, 60.0], [0.1, 12.0]], &mut Random::new(5, Purpose::Placement, 0, 0))
    }

    #[test]
    fn a_ray_meets_the_ground_where_small_steps_do() {
        let relief = hilly();
        let random = &mut Random::new(6, Purpose::Lidar, 0, 0);
        let mut met = 0;
        for _ in 0..300 {
            let origin = Point::new(random.normal(20.0), random.normal(20.0), 0.0);
            let origin = origin + Vector::z() * (relief.height(origin.x, origin.y) + 1.9);
            let direction = Vector::new(random.normal(1.0), random.normal(1.0), -random.between(0.05, 0.8));
            let ray = Ray { origin, direction: direction.normalize() };
            let over = |distance: f64| {
                let place = ray.origin + ray.direction * distance;
                place.z - relief.height(place.x, place.y)
            };
            let first = (0..6000).map(|step| f64::from(step) * 0.01).find(|distance| over(*distance) < 0.0);
            let (Some(first), Some(found)) = (first, relief.hit(&ray, 60.0)) else { continue };
            assert!(over(found).abs() < MET && found < first + 0.5, "{found} {first}");
            met += 1;
        }
        assert!(met > 200, "{met}");
    }

    #[test]
    fn a_vehicle_stands_as_the_ground_slopes() {
        let relief = hilly();
        let attitude = relief.attitude(7.0, -3.0, 0.8);
        let ahead = attitude * Vector::x();
        let step = 1e-4;
        let (sin, cos) = 0.8_f64.sin_cos();
        let rise = relief.height(7.0 + step * cos, -3.0 + step * sin) - relief.height(7.0, -3.0);
        assert!((ahead.z / ahead.xy().norm() - rise / step).abs() < 1e-4);
        assert!((ahead.y.atan2(ahead.x) - 0.8).abs() < 1e-9);
    }
}
