//! Echoes, and the radar that could hear them.

use super::equation::{ratio, snr_db};
use super::model::{RadarModel, Waves};
use crate::random::{Random, grain};
use crate::truth::Truth;
use crate::world::scene::Moment;
use ralf::label::Cause;
use ralf::space::{Point, Spherical, Transform, Vector};

/// Nothing is detected nearer than this, m.
pub(super) const NEAREST: f64 = 0.25;
/// Echoes so far below the threshold may still add up or be lifted by fluctuation, dB.
pub(super) const HOPE_DB: f64 = 6.0;

/// What arrives from a direction, in the radar's frame.
#[derive(Debug, Clone, Copy)]
pub(super) struct Echo {
    /// Where it seems to come from.
    pub(super) seen: Spherical,
    /// m/s, positive when receding.
    pub(super) range_rate: f64,
    /// Above noise, as a ratio.
    pub(super) power: f64,
    pub(super) truth: Truth,
}

/// A radar at one moment.
pub(super) struct View<'a> {
    pub(super) moment: &'a Moment<'a>,
    pub(super) radar: &'a RadarModel,
    pub(super) waves: &'a Waves,
    pub(super) site_from_radar: Transform,
    pub(super) radar_from_site: Transform,
    /// The antenna's velocity in the site's frame, m/s.
    pub(super) velocity: Vector,
}

impl View<'_> {
    /// The antenna's position in the site's frame.
    pub(super) fn origin(&self) -> Point {
        self.site_from_radar.translation.vector.into()
    }

    /// How a place is seen, if it is in view. What lies a little above or below the stated view is still heard.
    pub(super) fn seen(&self, place: &Point) -> Option<Spherical> {
        let seen = Spherical::from_cartesian(&(self.radar_from_site * place));
        let [azimuth, elevation] = self.radar.fov;
        let inside = seen.range > NEAREST
            && seen.range < self.radar.max_range
            && seen.azimuth.abs() <= azimuth / 2.0
            && seen.elevation.abs() <= 0.75 * elevation;
        inside.then_some(seen)
    }

    /// Range rate of a place that moves, m/s.
    pub(super) fn range_rate(&self, place: &Point, velocity: &Vector) -> f64 {
        let ray = place - self.origin();
        (velocity - self.velocity).dot(&ray) / ray.norm().max(1e-6)
    }

    /// Signal to noise of a cross-section where it is seen, dB; `None` where it is hopeless.
    pub(super) fn level_db(&self, seen: &Spherical, rcs_db: f64) -> Option<f64> {
        let level =
            snr_db(self.radar, rcs_db + self.waves.strength_db, seen.range, [seen.azimuth, seen.elevation]);
        (level > self.radar.threshold_db - HOPE_DB).then_some(level)
    }

    /// What lies between the radar and a place takes, there and back, dB.
    pub(super) fn loss_db(&self, place: &Point, own: &[usize]) -> Option<f64> {
        self.between_db(&self.origin(), place, own)
    }

    /// What lies between two places takes, there and back, dB.
    pub(super) fn between_db(&self, from: &Point, to: &Point, own: &[usize]) -> Option<f64> {
        self.moment.loss_db(from, to, own, self.waves.leaf_loss_db)
    }
}

/// How a level varies with the aspect: parts of a thing add up and cancel, and do so again at the same aspect, dB. The
/// ends of the lobes are `lobe` radians apart.
pub(super) fn glint_db(seed: u64, part: i64, aspect: f64, lobe: f64, spread_db: f64) -> f64 {
    let place = aspect / lobe;
    let node = |i: f64| {
        // Nearly normal: the sum of three even numbers.
        let sum: f64 = (0..3).map(|k| grain(seed, [part, i as i64, k])).sum();
        2.0 * (sum - 1.5)
    };
    let (low, share) = (place.floor(), place - place.floor());
    spread_db * (node(low) * (1.0 - share) + node(low + 1.0) * share)
}

impl Echo {
    pub(super) fn new(seen: Spherical, range_rate: f64, level_db: f64, truth: Truth) -> Self {
        Self { seen, range_rate, power: ratio(level_db), truth }
    }

    /// An artifact.
    pub(super) fn artifact(seen: Spherical, range_rate: f64, level_db: f64, cause: Cause) -> Self {
        Self::new(seen, range_rate, level_db, Truth::artifact(cause))
    }
}

/// Fluctuation from scan to scan, dB: a part of a thing that itself has parts (Swerling 3: chi-squared of four degrees
/// of freedom).
pub(super) fn fluctuation_db(random: &mut Random) -> f64 {
    let power = (random.exponential(1.0) + random.exponential(1.0)) / 2.0;
    super::equation::decibel(power.max(1e-3))
}
