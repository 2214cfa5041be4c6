//! What a correction rests on: how likely the measurements are under it.

use super::super::case::Case;
use super::beside::{BANDS, Beside, Put};
use super::quantity::{Values, values, with_values};
use crate::change::SensorChange;
use crate::doppler::predicted;
use nalgebra::Matrix2;
use ralf::space::Transform;

/// What a detection that lies on something counts, as a logarithm of likelihood: there are five times as many as beside
/// it, but those of a moment lie on the same walls, and a fifth of them count as independent.
const LIDAR_WEIGHT: f64 = 0.3;
/// A scan's velocity is right within this, m/s, whatever its noise, and within this share of the speed: yaw rates and
/// wheels are, and azimuths are off by half a degree.
const VELOCITY_SIGMA: (f64, f64) = (0.02, 0.01);
/// What a single scan's velocity can cost.
const VELOCITY_CAP: f64 = 4.0;
/// So far ahead and back, m, fewer detections lie on fronts than at the right place along the way, by so many standard
/// deviations of how many do.
const ASIDE: [f64; 6] = [-2.0, -1.5, -1.0, 1.0, 1.5, 2.0];
const CLEARLY: f64 = 2.5;
/// Stretches of time, whose measurements have little to do with each other.
pub(super) const STRETCHES: usize = 8;
/// Kinds of evidence: range rates, and the LiDAR by bands of range.
pub(super) const KINDS: usize = 1 + BANDS;

/// Something by kind of evidence, of each stretch of time: of all stretches of the first drive, then of the second.
pub(super) type Parts<T> = Vec<[T; KINDS]>;

/// Range rates of a radar, and its detections beside the LiDAR's points, in all drives of a vehicle.
pub(super) struct Evidence<'a> {
    drives: Vec<Drive<'a>>,
    /// What the quantities are added to: a mirror, a roll.
    base: SensorChange,
    /// So far behind the fronts of things the radar hears them, m.
    pub(super) behind: f64,
}

/// The same of one drive.
struct Drive<'a> {
    case: &'a Case<'a>,
    radar: usize,
    beside: Beside<'a>,
    /// Of the speed by range rates to the recorded one: wheels are known to half a percent, which is no matter of
    /// mounting or time.
    ratio: f64,
}

impl<'a> Evidence<'a> {
    /// Of a radar's number in each case. What is found starts from a change.
    pub(super) fn of(cases: &[(&'a Case<'a>, usize)], base: SensorChange, behind: f64) -> Self {
        Self { drives: cases.iter().map(|(case, radar)| Drive::of(case, *radar)).collect(), base, behind }
    }

    /// What was found before.
    pub(super) fn start(&self) -> Values {
        values(&self.base)
    }

    /// The change that these values are.
    pub(super) fn change(&self, values: &Values) -> SensorChange {
        with_values(&self.base, values)
    }

    /// The logarithm of the likelihood of everything, small corrections being likelier than large ones; but for a
    /// constant.
    pub(super) fn posterior(&self, values: &Values) -> f64 {
        self.likelihoods(values).iter().flatten().sum::<f64>() - values.norm_squared() / 2.0
    }

    /// How many stretches of time there are, of all drives.
    pub(super) fn stretches(&self) -> usize {
        self.drives.len() * STRETCHES
    }

    /// The parts of the evidence in which anything was measured.
    pub(super) fn observed(&self) -> Parts<bool> {
        self.drives.iter().flat_map(Drive::observed).collect()
    }

    /// The logarithm of the likelihood of each part of the evidence, but for a constant.
    pub(super) fn likelihoods(&self, values: &Values) -> Parts<f64> {
        let change = self.change(values);
        self.drives.iter().flat_map(|drive| drive.parts(&drive.put(&change, self.behind))).collect()
    }

    /// Whether the LiDAR tells how far along the way things are: where these values put them, clearly more detections
    /// lie on fronts than a little farther ahead and back. Along guard rails and walls as many do, and more the nearer
    /// they come to the LiDAR, which sees more there.
    pub(super) fn tells_along(&self, values: &Values) -> bool {
        let on_fronts = |metres: f64| -> f64 {
            let change = self.change(&(values + self::values(&SensorChange::shift(metres, 0.0))));
            let on_fronts = |drive: &Drive| drive.beside.on_fronts(&drive.put(&change, self.behind));
            self.drives.iter().flat_map(on_fronts).flatten().sum()
        };
        let there = on_fronts(0.0);
        let aside = ASIDE.iter().map(|metres| on_fronts(*metres)).sum::<f64>() / ASIDE.len() as f64;
        there - aside > CLEARLY * there.sqrt()
    }

    /// The posterior with what a LiDAR looks over as well: it may be off by a quarter of a metre, but knows one row of
    /// things from the next.
    pub(super) fn rough_posterior(&self, values: &Values) -> f64 {
        let change = self.change(values);
        let of_drive = |drive: &Drive| {
            let put = drive.put(&change, self.behind);
            let seen_whole = drive.parts(&put).iter().flatten().sum::<f64>();
            seen_whole + LIDAR_WEIGHT * drive.beside.looked_over(&put)
        };
        self.drives.iter().map(of_drive).sum::<f64>() - values.norm_squared() / 2.0
    }
}

impl<'a> Drive<'a> {
    fn of(case: &'a Case<'a>, radar: usize) -> Self {
        let figures = case.doppler(radar, &case.motion, &case.mount(radar));
        let ratio = figures.map_or(1.0, |figures| figures.ratio.value);
        Self { case, radar, beside: Beside::of(case, radar), ratio }
    }

    fn observed(&self) -> [[bool; KINDS]; STRETCHES] {
        let mut found = [[false; KINDS]; STRETCHES];
        let moments = self.beside.observed();
        let count = moments.len();
        for (i, bands) in moments.enumerate() {
            let stretch = &mut found[stretch(i, count)][1..];
            stretch.iter_mut().zip(bands).for_each(|(found, observed)| *found |= observed);
        }
        let scans = self.case.fits[self.radar].len();
        (0..scans).for_each(|i| found[stretch(i, scans)][0] = true);
        found
    }

    fn put<'b>(&'b self, change: &'b SensorChange, behind: f64) -> Put<'b> {
        Put { setup: self.case.setup(), radar: self.radar, change, behind }
    }

    fn parts(&self, put: &Put) -> [[f64; KINDS]; STRETCHES] {
        let (case, radar, change) = (self.case, self.radar, put.change);
        let mut found = [[0.0; KINDS]; STRETCHES];
        let moments = self.beside.on_fronts(put);
        for (i, bands) in moments.iter().enumerate() {
            for (sum, beside) in found[stretch(i, moments.len())][1..].iter_mut().zip(bands) {
                *sum += LIDAR_WEIGHT * beside;
            }
        }
        let mount = change.mount(&case.sequence.rig.radars[radar].vehicle_from_radar);
        let scans = case.fits[radar].len();
        for i in 0..scans {
            found[stretch(i, scans)][0] -= self.misfit(i, change, &mount);
        }
        found
    }

    /// What a scan's velocity costs.
    fn misfit(&self, scan: usize, change: &SensorChange, mount: &Transform) -> f64 {
        let timed = &self.case.fits[self.radar][scan];
        let told = predicted(&self.case.motion, mount, change.time(timed.t_ns));
        let off = timed.fit.velocity / self.ratio - told;
        let at_least = VELOCITY_SIGMA.0.powi(2) + (VELOCITY_SIGMA.1 * told.norm()).powi(2);
        let covariance = timed.fit.covariance + Matrix2::identity() * at_least;
        let squared = covariance.try_inverse().map_or(0.0, |inverse| (off.transpose() * inverse * off)[0]);
        (squared / 2.0).min(VELOCITY_CAP)
    }
}

/// The stretch of time of one of so many measurements.
fn stretch(i: usize, count: usize) -> usize {
    i * STRETCHES / count
}
