//! The ground, noise, rain, interference, and the own bumper.

use super::echo::{Echo, NEAREST, View, glint_db};
use super::equation::decibel;
use crate::random::{Random, grain};
use crate::truth::Truth;
use crate::world::terrain::Surface;
use ralf::label::Cause;
use ralf::space::{Point, Spherical, Vector};

/// Side of a piece of ground, m.
const PIECE: f64 = 1.0;
/// The ground is heard up to here, m.
const REACH: f64 = 60.0;
/// Grazing angle at which backscatter is stated: sine of 10 degrees.
const STATED: f64 = 0.1736;
/// How often a piece of road has a manhole, a joint or a stud in it, and how much that is worth, dB.
const LUMPS: (f64, f64) = (0.015, 14.0);

/// The ground, piece by piece: each has a place where it reflects best and a strength, and both stay from scan to scan;
/// speckle is new in each.
pub(super) fn ground(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let reach = REACH.min(view.radar.max_range);
    let origin = view.origin();
    let steps = (reach / PIECE).ceil() as i64;
    let [i0, j0] = [(origin.x / PIECE).floor() as i64, (origin.y / PIECE).floor() as i64];
    let ahead = view.site_from_radar.rotation * Vector::x();
    let edge = (view.radar.fov[0] / 2.0).cos().min(0.999);
    let mut found = Vec::new();
    for i in -steps..=steps {
        for j in -steps..=steps {
            let way = Vector::new(i as f64 * PIECE, j as f64 * PIECE, 0.0);
            let range = way.norm();
            // Roughly in view; the rest is asked of the place itself.
            if range < reach && (range < 3.0 || way.dot(&ahead) > (edge - 0.1) * range) {
                let speckle = random.exponential(1.0);
                found.extend(piece(view, [i0 + i, j0 + j], speckle));
            }
        }
    }
    found
}

fn piece(view: &View<'_>, [i, j]: [i64; 2], speckle: f64) -> Option<Echo> {
    let site = view.moment.site;
    let share = |k: i64| grain(site.seed ^ 0x6_7261_7373, [i, j, k]);
    let (x, y) = ((i as f64 + share(0)) * PIECE, (j as f64 + share(1)) * PIECE);
    let patch = site.terrain.patch(x, y);
    let place = Point::new(x, y, site.terrain.height(x, y) + patch.pile * share(2));
    let seen = view.seen(&place)?;
    let grazing = ((view.origin().z - place.z) / seen.range).max(0.005);
    let texture = glint_db(site.seed ^ 0x72, i * 65_536 + j, 0.0, 1.0, view.waves.texture_db);
    let lump = if patch.surface != Surface::Grass && share(3) < LUMPS.0 { LUMPS.1 } else { 0.0 };
    let rcs = view.waves.asphalt_db
        + patch.surface.roughness_db()
        + 15.0 * (grazing / STATED).log10()
        + decibel(PIECE * PIECE)
        + texture
        + lump
        + decibel(speckle.max(1e-3));
    let level = view.level_db(&seen, rcs)?;
    let loss = view.loss_db(&(place + Vector::z() * 0.05), None)?;
    let truth = match patch.surface {
        Surface::Grass => Truth { class: patch.surface.class(), cause: Cause::Plausible },
        _ => Truth::artifact(Cause::Road),
    };
    Some(Echo::new(seen, view.range_rate(&place, &Vector::zeros()), level - loss, truth))
}

/// False alarms: anywhere, at any range rate, just above the threshold.
pub(super) fn noise(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let count = random.poisson(view.radar.false_alarms.min(500.0));
    let alarm = |_| {
        let seen = anywhere(view, random);
        let rate = random.between(-0.5, 0.5) * view.radar.doppler_interval;
        let level = view.radar.threshold_db + 0.3 + random.exponential(1.5);
        Echo::artifact(seen, rate, level, Cause::Noise)
    };
    (0..count).map(alarm).collect()
}

fn anywhere(view: &View<'_>, random: &mut Random) -> Spherical {
    Spherical {
        range: random.between(NEAREST, view.radar.max_range),
        azimuth: random.between(-0.5, 0.5) * view.radar.fov[0],
        elevation: random.between(-0.5, 0.5) * view.radar.fov[1],
    }
}

/// Drops nearby, which fall and drift.
pub(super) fn rain(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    if !view.waves.rain {
        return Vec::new();
    }
    let drop = |_| {
        let seen = Spherical { range: 1.0 + random.exponential(3.0), ..anywhere(view, random) };
        let place = view.site_from_radar * seen.to_cartesian();
        let falling = Vector::new(random.normal(1.5), random.normal(1.5), -random.between(3.0, 8.0));
        let level = view.radar.threshold_db + random.normal(4.0);
        Echo::artifact(seen, view.range_rate(&place, &falling), level, Cause::Noise)
    };
    (0..12).map(drop).collect()
}

/// Another radar's chirps: a burst of detections toward it, at any range and rate. What is left of the spectrum is
/// noisier by so many dB.
pub(super) fn interference(view: &View<'_>, random: &mut Random) -> (Vec<Echo>, f64) {
    if !random.chance(view.waves.interference) {
        return (Vec::new(), 0.0);
    }
    let azimuth = random.between(-0.5, 0.5) * view.radar.fov[0];
    let count = 4 + random.poisson(14.0);
    let burst = |_| {
        let elevation = random.normal(0.02);
        let seen = Spherical { azimuth: azimuth + random.normal(0.03), elevation, ..anywhere(view, random) };
        let rate = random.between(-0.5, 0.5) * view.radar.doppler_interval;
        let level = view.radar.threshold_db + 6.0 + random.exponential(5.0);
        Echo::artifact(seen, rate, level, Cause::Interference)
    };
    ((0..count).map(burst).collect(), random.between(1.0, 6.0))
}

/// The own bumper and what hangs from it: they stay where they are, and move with the radar.
pub(super) fn bumper(view: &View<'_>, random: &mut Random) -> Vec<Echo> {
    let name = view.radar.name.bytes().fold(0_i64, |sum, byte| sum * 31 % 1_000_003 + i64::from(byte));
    let mut found = Vec::new();
    for number in 0..view.waves.bumper {
        let share = |k: i64| grain(0xb0b, [name, number as i64, k]);
        // Seen now and then, each with its own patience.
        if random.chance(0.2 + 0.7 * share(0)) {
            let seen = Spherical {
                range: NEAREST + 0.05 + 1.6 * share(1) * share(2),
                azimuth: (share(3) - 0.5) * view.radar.fov[0],
                elevation: (share(4) - 0.5) * view.radar.fov[1],
            };
            let level = view.radar.threshold_db + 25.0 * share(5) + random.normal(2.0);
            found.push(Echo::artifact(seen, random.normal(0.02), level, Cause::OwnVehicle));
        }
    }
    found
}
