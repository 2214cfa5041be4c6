//! Side lobes of what is strong: in angle, by a pattern that belongs to the sensor, and in range.

use super::view::{Echo, THRESHOLD_DB, View};
use crate::random::Random;
use crate::truth::Truth;
use ralf::label::Cause;
use ralf::space::Spherical;

/// Of what rises so far above the threshold, dB.
const STRONG_DB: f64 = 11.0;
/// How often a lobe is told.
const TOLD: f64 = 0.6;
/// Lobes in range, in parts of one and a half cells.
const IN_RANGE: [f64; 5] = [-3.0, -2.0, 2.0, 3.0, 5.0];

pub(super) fn side_lobes(view: &View<'_>, echoes: &[Echo], random: &mut Random) -> Vec<Echo> {
    let mut found = Vec::new();
    for echo in echoes.iter().filter(|echo| echo.level_db > THRESHOLD_DB + STRONG_DB) {
        for [aside, below] in &view.radar.lobes {
            found.extend(in_angle(view, echo, *aside, *below, random));
        }
        for cells in IN_RANGE {
            found.extend(in_range(view, echo, cells, random));
        }
    }
    found
}

fn in_angle(view: &View<'_>, echo: &Echo, aside: f64, below: f64, random: &mut Random) -> Option<Echo> {
    let level_db = echo.level_db - below - random.exponential(3.0);
    let sine = echo.seen.azimuth.sin() + aside + random.normal(0.012);
    let ahead = sine.abs() < view.radar.half_view[0].sin();
    if level_db < THRESHOLD_DB || !ahead || !random.chance(TOLD) {
        return None;
    }
    let [sigma_range, _, sigma_elevation] = view.radar.sigmas;
    let seen = Spherical {
        range: echo.seen.range + random.normal(sigma_range),
        azimuth: sine.asin(),
        elevation: view.clamped(echo.seen.elevation + random.normal(2.5 * sigma_elevation)),
    };
    let rate = echo.rate + random.normal(0.03);
    Some(Echo { seen, rate, level_db, truth: Truth::artifact(Cause::SideLobe) })
}

fn in_range(view: &View<'_>, echo: &Echo, cells: f64, random: &mut Random) -> Option<Echo> {
    let level_db = echo.level_db - view.radar.range_lobe_db - 2.0 * cells.abs() - random.exponential(3.0);
    let range = echo.seen.range + 1.5 * cells * view.radar.cell[0];
    if level_db < THRESHOLD_DB || range < 0.3 {
        return None;
    }
    let [_, sigma_azimuth, sigma_elevation] = view.radar.sigmas;
    let seen = Spherical {
        range,
        azimuth: echo.seen.azimuth + random.normal(2.0 * sigma_azimuth),
        elevation: view.clamped(echo.seen.elevation + random.normal(2.0 * sigma_elevation)),
    };
    Some(Echo { seen, rate: echo.rate, level_db, truth: Truth::artifact(Cause::SideLobe) })
}
