//! A radar at one moment.

use crate::random::Random;
use crate::sketch::moment::Moment;
use crate::sketch::rig::RadarModel;
use crate::truth::Truth;
use ralf::space::{Point, Spherical, Transform, Vector};

/// What rises so far above noise is detected, dB.
pub(super) const THRESHOLD_DB: f64 = 12.0;
/// The antenna's two-way loss at the edge of its view, dB.
const EDGE_DB: f64 = 9.0;
/// One in so many angles is off by more than the sensor says, and by how many times.
const OUTLIERS: (f64, [f64; 2]) = (0.05, [2.0, 6.0]);

/// What a radar tells of.
#[derive(Debug, Clone, Copy)]
pub(in crate::sketch) struct Echo {
    pub(super) seen: Spherical,
    /// m/s, positive when receding.
    pub(super) rate: f64,
    /// Above noise.
    pub(super) level_db: f64,
    pub(super) truth: Truth,
}

/// A radar in its place.
pub(in crate::sketch) struct View<'a> {
    pub(in crate::sketch) moment: &'a Moment<'a>,
    pub(in crate::sketch) radar: &'a RadarModel,
    pub(in crate::sketch) site_from_radar: Transform,
    /// Of the antenna in the site's frame, m/s.
    pub(in crate::sketch) velocity: Vector,
    /// x, y (m) and strength (dBsm) of the ground's spots.
    pub(in crate::sketch) ground: &'a [[f64; 3]],
}

/// By how much a measurement is off.
#[derive(Debug, Clone, Copy)]
pub(super) struct Errors {
    /// m, rad and rad.
    pub(super) off: [f64; 3],
    /// How much worse azimuths are there than ahead.
    pub(super) edge: f64,
}

impl View<'_> {
    pub(super) fn origin(&self) -> Point {
        self.site_from_radar.translation.vector.into()
    }

    /// How high the antenna is above the ground, m.
    pub(super) fn height(&self) -> f64 {
        let origin = self.origin();
        origin.z - self.moment.scene().relief.height(origin.x, origin.y)
    }

    pub(super) fn seen(&self, place: &Point) -> Spherical {
        Spherical::from_cartesian(&(self.site_from_radar.inverse() * place))
    }

    /// Range rate of a place that moves, m/s.
    pub(super) fn rate(&self, place: &Point, velocity: &Vector) -> f64 {
        let way = place - self.origin();
        (velocity - self.velocity).dot(&way) / way.norm().max(1e-6)
    }

    /// Level of 0 dBsm at a range, before the antenna's pattern.
    pub(super) fn level_db(&self, range: f64) -> f64 {
        unit_db(self.radar) - 40.0 * range.max(0.1).log10()
    }

    /// The antenna's pattern, there and back.
    pub(super) fn gain_db(&self, azimuth: f64, elevation: f64) -> f64 {
        gain_db(self.radar, azimuth, elevation)
    }

    /// Whether it is within the view to the sides.
    pub(super) fn is_ahead(&self, azimuth: f64) -> bool {
        azimuth.abs() < self.radar.half_view[0]
    }

    /// Within the stated view up and down, rad.
    pub(super) fn clamped(&self, elevation: f64) -> f64 {
        let high = self.radar.half_view[1];
        elevation.clamp(-high, high)
    }

    /// How far a measurement of a level is off, so many times as far as is usual.
    pub(super) fn errors(&self, azimuth: f64, level_db: f64, times: f64, random: &mut Random) -> Errors {
        let [range, sideways, up] = self.radar.sigmas;
        let worse = 10.0_f64.powf((18.0 - level_db) / 30.0).clamp(0.45, 1.6) * times;
        let edge = (1.0 / azimuth.clamp(-1.35, 1.35).cos()).clamp(1.0, 3.0);
        let outlier =
            if random.chance(OUTLIERS.0) { random.between(OUTLIERS.1[0], OUTLIERS.1[1]) } else { 1.0 };
        let off = [
            random.normal(range * worse),
            random.normal(sideways * worse * edge * outlier),
            random.normal(up * worse * outlier),
        ];
        Errors { off, edge }
    }

    /// Measured with an error.
    pub(super) fn measured(
        &self,
        seen: Spherical,
        level_db: f64,
        times: f64,
        random: &mut Random,
    ) -> Spherical {
        let [range, azimuth, elevation] = self.errors(seen.azimuth, level_db, times, random).off;
        Spherical {
            range: seen.range + range,
            azimuth: seen.azimuth + azimuth,
            elevation: seen.elevation + elevation,
        }
    }
}

/// How far off what two things of one range differ in is told apart, m.
pub(super) fn told_apart(radar: &RadarModel) -> f64 {
    (3.0 * radar.sigmas[0]).max(radar.cell[0])
}

/// Cross-section that belongs to a level, dBsm.
pub(super) fn rcs_db(radar: &RadarModel, seen: &Spherical, level_db: f64) -> f64 {
    level_db - unit_db(radar) + 40.0 * seen.range.max(0.1).log10()
        - gain_db(radar, seen.azimuth, seen.elevation)
}

fn unit_db(radar: &RadarModel) -> f64 {
    13.0 + 40.0 * radar.reach.log10()
}

fn gain_db(radar: &RadarModel, azimuth: f64, elevation: f64) -> f64 {
    let [wide, high] = radar.half_view;
    -EDGE_DB * ((azimuth / wide).powi(2) + (elevation / high).powi(2))
}

/// How a level varies from scan to scan (gamma distribution, shape 1.3 or so), dB.
pub(super) fn fading_db(random: &mut Random) -> f64 {
    let power = 0.77 * random.exponential(1.0) + 0.23 * random.normal(1.0).powi(2);
    10.0 * (power + 1e-4).log10()
}
