//! How strong an echo is among its own: the radar equation and the radar's detection threshold, without anything
//! absolute, for which radars would have to be calibrated.
//!
//! The cross-section tells what reflected, the power (cross-section less `40 log10 r`) how far the echo stood out of
//! the noise. Noise and clutter crowd just above the threshold; what a real object sends back often does not.

use super::columns::unobserved;
use super::rings::Rings;
use super::statistics::{median_of, quantile, quantile_guessed, ranks};
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{Frame, Ordered, Strength};

pub(super) const PIECE: Piece = Piece {
    features: &[
        feature("amplitude_rank", "1", "share of the scan's other detections whose cross-section is smaller"),
        feature(
            "amplitude_power_rank",
            "1",
            "share of the scan's other detections whose power, cross-section less 40 log10 of range, is smaller",
        ),
        feature(
            "amplitude_over_ring",
            "dB",
            "cross-section above the median of the scan's detections within 5 m of the whole metre nearest to its \
             range",
        ),
        feature(
            "amplitude_over_floor",
            "dB",
            "power above the radar's own floor, which 2 % of its detections in the scans around lie below",
        ),
        feature(
            "amplitude_over_ring_floor",
            "dB",
            "power above the floor at this range, which 5 % of the radar's detections in the scans around lie below, \
             of those within 5 m of the whole metre nearest to its range",
        ),
    ],
    observe,
};

/// So many of a radar's detections lie below its floor.
const FLOOR: f64 = 0.02;
/// The same of one ring, which holds fewer.
const RING_FLOOR: f64 = 0.05;

const fn feature(name: &'static str, unit: &'static str, meaning: &'static str) -> Feature {
    Feature { name, unit, group: "Amplitude", meaning }
}

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let Some(strength) = frame.strength() else {
        return unobserved(PIECE.features, frame.scan.len());
    };
    let ranges: Vec<f64> = frame.scan.measured.spherical.iter().map(|place| place.range).collect();
    let around = around(frame);
    let powers: Vec<f64> = around.iter().flat_map(|scan| &scan.power).copied().collect();
    let own = Ordered::new(ranges.iter().copied(), strength.cross_section.iter().copied());
    let rings = Rings::new(around.iter().map(|scan| &scan.power_by_range));
    vec![
        ranks(&strength.cross_section),
        ranks(&strength.power),
        Rings::new([&own].into_iter()).over(&strength.cross_section, &ranges, |ring, _| median_of(ring)),
        over(&strength.power, quantile(&powers, FLOOR)),
        rings.over(&strength.power, &ranges, ring_floor),
    ]
}

/// The strengths of all echoes of one radar in the scan and those around.
fn around<'a>(frame: &'a Frame) -> Vec<&'a Strength> {
    let around = frame.own_scans_around().map(|neighbour| &neighbour.scan);
    [&frame.scan].into_iter().chain(around).filter_map(|scan| scan.strength(frame.radar)).collect()
}

fn over(values: &[f64], level: Option<f64>) -> Values {
    values.iter().map(|value| Some(value - level?)).collect()
}

/// `nearer` is that of a ring nearer by: mostly no lower, since power falls with range.
fn ring_floor(powers: &[f64], nearer: Option<f64>) -> Option<f64> {
    quantile_guessed(powers, RING_FLOOR, nearer.unwrap_or(f64::INFINITY))
}
