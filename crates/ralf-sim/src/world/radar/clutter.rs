//! Noise, rain, interference, and the own bumper.

use super::echo::{Echo, NEAREST, View};
use super::equation::snr_db;
use crate::random::{Random, grain};
use ralf::label::Cause;
use ralf::space::{Spherical, Vector};

/// Cross-sections of clips, brackets and number plates, dBsm (chosen).
const BUMPER_DB: (f64, f64) = (-40.0, 0.0);

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
            let rcs = BUMPER_DB.0 + (BUMPER_DB.1 - BUMPER_DB.0) * share(5) + random.normal(2.0);
            let level = snr_db(view.radar, rcs, seen.range, [seen.azimuth, seen.elevation]);
            found.push(Echo::artifact(seen, random.normal(0.02), level, Cause::OwnVehicle));
        }
    }
    found
}
