//! Spikes of clutter: what little edges and facets send from anywhere on the ground, strongly and seldom.
//!
//! At low grazing angles a surface is no even rug: the spread between its cells grows, and what is heard are spikes
//! (Billingsley 2002, Low-Angle Radar Land Clutter; Kulemin 2003, millimetre waves). Such clutter is compound Gaussian:
//! speckle times a texture, gamma distributed where clutter is K-distributed (Ward, Tough and Watts 2013). Texture that
//! is gamma distributed on every area, whatever its size, is a Poisson process of spikes whose strengths lie as
//! `exp(-x) / x`. A part of the spikes belongs to the place: edges, stones, studs. Others are facets that shine into
//! a few milliradians (wavelength over twice their size), and are gone in the next scan.

use super::echo::{Echo, HOPE_DB, View};
use super::equation::{REFERENCE_RANGE, decibel, ratio, snr_db};
use super::model::Spikiness;
use crate::random::{Random, grain};
use crate::world::terrain::Surface;
use ralf::space::{Point, Vector};

/// Stronger ones than so many times the scale hardly exist.
const STRONGEST: f64 = 8.0;
/// Weaker ones aren't looked for: they are part of the rug, or they aren't heard.
const WEAKEST: f64 = 1e-3;
/// The weakest of those that belong to a place.
const WEAKEST_STAYING: f64 = 0.01;
/// Side of the squares in which staying spikes are drawn, m.
const SQUARE: f64 = 2.0;
/// Half the depth of a ring in which new ones are drawn, m.
const HALF_RING: f64 = 2.5;

/// Candidates on a square metre of a strength from `least` on: they lie as `1 / x`, and `exp(-x)` of them are kept.
fn density(spikes: &Spikiness, least: f64) -> f64 {
    // The mean of a gamma distribution is its shape times its scale.
    let shape = ratio(spikes.mean_db - spikes.scale_db);
    shape * (STRONGEST / least).ln()
}

/// A candidate's strength from two even numbers, in units of the scale, if it is kept.
fn strength(least: f64, which: f64, kept: f64) -> Option<f64> {
    let x = least * (STRONGEST / least).powf(which);
    (kept < (-x).exp()).then_some(x)
}

/// Those that belong to the place.
pub(super) fn staying(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let spikes = view.waves.spikes;
    let seed = view.moment.site.seed ^ 0x73_7069_6b65;
    let often = density(&spikes, WEAKEST_STAYING) * spikes.staying * SQUARE * SQUARE;
    let origin = view.origin();
    let reach = reach(view);
    let steps = (reach / SQUARE).ceil() as i64;
    let [i0, j0] = [(origin.x / SQUARE).floor() as i64, (origin.y / SQUARE).floor() as i64];
    let mut found = Vec::new();
    for (i, j) in (-steps..=steps).flat_map(|i| (-steps..=steps).map(move |j| (i0 + i, j0 + j))) {
        // As many as there are on average, one more or less.
        let count = (often + grain(seed, [i, j, 0])) as i64;
        let [dx, dy] = [(i as f64 + 0.5) * SQUARE - origin.x, (j as f64 + 0.5) * SQUARE - origin.y];
        // Nothing of a square is nearer, and weaker ones aren't heard from there.
        let nearest = (dx.hypot(dy) - SQUARE).max(0.1);
        let least = ratio(-margin_db(view, 0.0, nearest));
        for number in 0..count {
            let share = |k: i64| grain(seed, [i, j, 8 * number + k]);
            let Some(x) = strength(WEAKEST_STAYING, share(1), share(2)) else { continue };
            let x = x * random.exponential(1.0);
            if x > least && share(6) * nearest <= spikes.shadow {
                let place = [(i as f64 + share(3)) * SQUARE, (j as f64 + share(4)) * SQUARE];
                found.extend(spike(view, place, x, [share(5), share(6)]));
            }
        }
    }
    found
}

/// Those of this scan alone.
pub(super) fn passing(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let spikes = view.waves.spikes;
    let origin = view.origin();
    let ahead = view.site_from_radar.rotation * Vector::x();
    let heading = ahead.y.atan2(ahead.x);
    let reach = reach(view);
    let mut found = Vec::new();
    let mut middle = HALF_RING;
    while middle - HALF_RING < reach {
        // The area of a piece of a ring, and the weakest spike that could be heard from it.
        let area = 2.0 * HALF_RING * middle * view.radar.fov[0];
        let least = ratio(-margin_db(view, 0.0, middle)).clamp(WEAKEST, 0.5 * STRONGEST);
        let density = density(&spikes, least) * (1.0 - spikes.staying);
        for _ in 0..random.poisson((density * area).min(500.0)) {
            let [along, across, which, kept, green, hidden] = [(); 6].map(|()| random.uniform());
            let range = middle + (2.0 * along - 1.0) * HALF_RING;
            let angle = heading + (across - 0.5) * view.radar.fov[0];
            let place = [origin.x + range * angle.cos(), origin.y + range * angle.sin()];
            let speckle = random.exponential(1.0);
            found.extend(
                strength(least, which, kept).and_then(|x| spike(view, place, x * speckle, [green, hidden])),
            );
        }
        middle += 2.0 * HALF_RING;
    }
    found
}

/// How far a spike of so many times the scale (dB) on boresight is above what could be heard, dB.
fn margin_db(view: &View<'_>, strength_db: f64, range: f64) -> f64 {
    let rcs = view.waves.spikes.scale_db + strength_db + view.waves.strength_db;
    snr_db(view.radar, rcs, range, [0.0; 2]) - view.radar.threshold_db + HOPE_DB
}

/// How far the strongest of them could be heard, m.
fn reach(view: &View<'_>) -> f64 {
    let margin = margin_db(view, decibel(STRONGEST), REFERENCE_RANGE);
    (REFERENCE_RANGE * 10.0_f64.powf(margin / 40.0)).min(view.radar.max_range)
}

fn spike(view: &View<'_>, [x, y]: [f64; 2], strength: f64, [green, hidden]: [f64; 2]) -> Option<Echo> {
    let spikes = &view.waves.spikes;
    let terrain = &view.moment.site.terrain;
    let surface = terrain.patch(x, y).surface;
    if surface == Surface::Grass && green > spikes.on_grass {
        return None;
    }
    let rcs = spikes.scale_db + decibel(strength.max(1e-6));
    let place = Point::new(x, y, terrain.height(x, y));
    let seen = view.seen(&place)?;
    if hidden * seen.range > spikes.shadow {
        return None;
    }
    let level = view.level_db(&seen, rcs)?;
    let loss = view.loss_db(&(place + Vector::z() * 0.05), &[])?;
    Some(Echo::new(seen, view.range_rate(&place, &Vector::zeros()), level - loss, surface.truth()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Purpose;

    #[test]
    fn strengths_are_a_gamma_process_of_the_mean_that_is_asked_for() {
        let spikes = Spikiness { mean_db: -10.0, scale_db: 0.0, staying: 0.5, shadow: 25.0, on_grass: 0.1 };
        let random = &mut Random::new(1, Purpose::Radar, 0, 0);
        let (mut sum, mut squares) = (0.0, 0.0);
        let square_metres = 40_000.0;
        for _ in 0..(square_metres * density(&spikes, WEAKEST)) as usize {
            let x = strength(WEAKEST, random.uniform(), random.uniform()).unwrap_or(0.0);
            sum += x;
            squares += x * x;
        }
        // Of a shape of 0.1 a square metre and a scale of 1: mean and variance are 0.1, too.
        assert!((sum / square_metres - 0.1).abs() < 0.005, "{}", sum / square_metres);
        assert!((squares / square_metres - 0.1).abs() < 0.01, "{}", squares / square_metres);
    }
}
