//! The echoes of a scan, and which stronger ones lie before and beside each of them.

use super::Surroundings;
use super::distance::ROOM;
use super::rates::Rates;
use crate::scene::{Ordered, Strength};
use std::f64::consts::{PI, SQRT_2, TAU};

/// Ranges and azimuths are the same if they differ by no more, in standard deviations of such a difference.
const SAME: f64 = 2.0;

/// What the scan's echoes are: one entry per detection of each list.
pub(super) struct Echoes<'a> {
    strength: &'a Strength,
    /// As the radar measured them, m/s, and how well.
    rates: Option<(&'a [f64], &'a Rates)>,
    /// m
    ranges: Vec<f64>,
    /// rad
    azimuths: Vec<f64>,
    by_range: Ordered<Echo>,
    by_azimuth: Ordered<Reflector>,
    /// Standard deviation of a range, m.
    sigma_range: f64,
    /// Standard deviation of an azimuth, rad.
    sigma_azimuth: f64,
}

/// What is asked of an echo behind which others lie.
struct Reflector {
    /// m
    range: f64,
    /// dB
    cross_section: f64,
}

/// What is asked of an echo beside others.
struct Echo {
    /// Its place in the scan.
    detection: usize,
    /// rad
    azimuth: f64,
    /// dB
    power: f64,
}

/// Stronger echoes before a detection.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Before {
    /// How many.
    pub(super) count: Option<f64>,
    /// Along the ray from the nearest of them, m.
    pub(super) distance: Option<f64>,
    /// Least distance of the range from twice that of one of them, in standard deviations.
    pub(super) double_bounce: Option<f64>,
}

/// Echoes beside a detection, at its range.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Beside {
    /// Share of them that have less power.
    pub(super) rank: Option<f64>,
    /// To the nearest that has more, degrees.
    pub(super) angle: Option<f64>,
    /// How much more power the strongest of its range rate has that lies at another azimuth, dB.
    pub(super) side_lobe: Option<f64>,
}

impl<'a> Echoes<'a> {
    /// The echoes of a scan; `None` where the radar doesn't measure how strong they are.
    pub(super) fn new(surroundings: &'a Surroundings) -> Option<Self> {
        let frame = surroundings.frame;
        let places = &frame.scan.measured.spherical;
        let ranges: Vec<f64> = places.iter().map(|place| place.range).collect();
        let azimuths: Vec<f64> = places.iter().map(|place| place.azimuth).collect();
        let strength = frame.strength()?;
        let reflectors = ranges.iter().zip(&strength.cross_section);
        let reflectors = reflectors
            .map(|(range, cross_section)| Reflector { range: *range, cross_section: *cross_section });
        let echoes = azimuths.iter().zip(&strength.power).enumerate();
        let echoes =
            echoes.map(|(detection, (azimuth, power))| Echo { detection, azimuth: *azimuth, power: *power });
        Some(Self {
            strength,
            rates: frame.doppler().map(|doppler| doppler.raw.as_slice()).zip(surroundings.rates()),
            by_range: Ordered::new(ranges.iter().copied(), echoes),
            by_azimuth: Ordered::new(azimuths.iter().copied(), reflectors),
            ranges,
            azimuths,
            sigma_range: frame.radar.sigma_range.hypot(ROOM),
            sigma_azimuth: frame.radar.sigma_azimuth,
        })
    }

    /// The echoes before a detection at its azimuth, of a larger cross-section.
    pub(super) fn before(&self, i: usize) -> Before {
        let (range, cross_section) = (self.ranges[i], self.strength.cross_section[i]);
        if !(range.is_finite() && cross_section.is_finite()) {
            return Before::default();
        }
        let (mut count, mut last, mut bounce) = (0, f64::NEG_INFINITY, f64::INFINITY);
        let end = range - SAME * SQRT_2 * self.sigma_range;
        for other in self.towards(self.azimuths[i]) {
            // Without a branch: nobody foresees it.
            let counts = (other.range < end) & (other.cross_section > cross_section);
            count += i32::from(counts);
            last = if counts & (other.range > last) { other.range } else { last };
            let off = (range - 2.0 * other.range).abs();
            bounce = if counts & (off < bounce) { off } else { bounce };
        }
        // The variance of r_i - 2 r_j is five times that of a range.
        let found = |value: f64| Some(value).filter(|_| count > 0);
        Before {
            count: Some(f64::from(count)),
            distance: found(range - last),
            double_bounce: found(bounce / (5.0f64.sqrt() * self.sigma_range)),
        }
    }

    /// The reflectors at an azimuth; behind the radar one turn ends and the next begins.
    fn towards(&self, azimuth: f64) -> impl Iterator<Item = &Reflector> {
        let tolerance = (SAME * SQRT_2 * self.sigma_azimuth).min(PI);
        let within = move |turn: f64| {
            let azimuth = azimuth + turn;
            self.by_azimuth.within(azimuth - tolerance..=azimuth + tolerance)
        };
        let beyond = if azimuth + tolerance > PI { Some(-TAU) } else { None };
        let beyond = beyond.or((azimuth - tolerance < -PI).then_some(TAU));
        within(0.0).iter().chain(beyond.into_iter().flat_map(within))
    }

    /// The echoes beside a detection.
    pub(super) fn beside(&self, i: usize) -> Beside {
        let (range, power) = (self.ranges[i], self.strength.power[i]);
        if !power.is_finite() {
            return Beside::default();
        }
        let (mut less, mut others) = (0, 0);
        let (mut angle, mut side_lobe) = (f64::INFINITY, f64::NEG_INFINITY);
        let tolerance = SAME * SQRT_2 * self.sigma_range;
        for other in self.by_range.within(range - tolerance..=range + tolerance) {
            let over = other.power - power;
            if other.detection == i || over.is_nan() {
                continue;
            }
            others += 1;
            less += i32::from(over < 0.0);
            let apart = (other.azimuth - self.azimuths[i]).abs();
            let away = apart.min(TAU - apart);
            angle = if (over > 0.0) & (away < angle) { away } else { angle };
            let is_stronger = over > side_lobe && away > SAME * SQRT_2 * self.sigma_azimuth;
            if is_stronger && self.at_same_rate(i, other.detection) {
                side_lobe = over;
            }
        }
        Beside {
            rank: (others > 0).then(|| f64::from(less) / f64::from(others)),
            angle: Some(angle.to_degrees()).filter(|angle| angle.is_finite()),
            side_lobe: Some(side_lobe).filter(|over| over.is_finite()),
        }
    }

    fn at_same_rate(&self, i: usize, j: usize) -> bool {
        self.rates.as_ref().is_some_and(|(raw, rates)| rates.are_of_one_echo(raw[i], raw[j]))
    }
}
