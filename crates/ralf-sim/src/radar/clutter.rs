//! Echoes of nothing in particular: the road's texture, and noise.

use super::{Echo, RANGE, View};
use crate::random::Random;
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::space::{Point, Spherical, Vector};

/// The road is seen up to here, m.
const ROAD_REACH: f64 = 45.0;

/// The road, anew in every scan: a wave that grazes it finds another grain each time the vehicle has moved by a
/// wavelength.
pub(super) fn road(view: &View<'_>, size: f64, random: &mut Random) -> Vec<Echo> {
    let origin = view.origin();
    let mut found = Vec::new();
    // Most of them lie behind something or outside the field of view.
    for _ in 0..(1.5 * size) as usize {
        // Nearer places come more often.
        let range = 2.0 + (ROAD_REACH - 2.0) * random.uniform().powf(1.5);
        let azimuth = random.between(-0.5, 0.5) * view.radar.fov_azimuth;
        let level_db = random.normal(4.0);
        let ray = view.site_from_radar.rotation * Vector::new(azimuth.cos(), azimuth.sin(), 0.0);
        let (x, y) = (origin.x + range * ray.x, origin.y + range * ray.y);
        let position = Point::new(x, y, view.scene.site.ground.height(x, y));
        let seen = || view.scene.radar_loss_db(&origin, &(position + Vector::z() * 0.05), None);
        if view.range_in_view(&position).is_some() && seen().is_some_and(|loss_db| loss_db < 10.0) {
            found.push(Echo {
                position,
                range_rate: view.range_rate(&position, &Vector::zeros()),
                level_db,
                truth: Truth::artifact(Cause::Road),
            });
        }
    }
    found
}

/// Noise: anywhere, at any velocity.
pub(super) fn noise(view: &View<'_>, size: f64, random: &mut Random) -> Vec<Echo> {
    let mut one = || {
        let spherical = Spherical {
            range: random.between(RANGE.0, RANGE.1),
            azimuth: random.between(-0.5, 0.5) * view.radar.fov_azimuth,
            elevation: random.between(-0.5, 0.5) * view.radar.fov_elevation,
        };
        Echo {
            position: view.site_from_radar * spherical.to_cartesian(),
            range_rate: random.between(-12.0, 12.0),
            level_db: random.normal(3.0),
            truth: Truth::artifact(Cause::Noise),
        }
    };
    (0..size as usize).map(|_| one()).collect()
}
