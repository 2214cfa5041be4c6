//! From echoes to what the radar reports.

use super::antenna::{confused, reflected_by_road};
use super::cfar::Floor;
use super::echo::{Echo, NEAREST, View};
use super::equation::{apparent_rcs_db, decibel, folded};
use super::model::{Amplitude, Keeps, RadarModel};
use crate::random::Random;
use crate::truth::Truth;
use ralf::sensors::{Radar, RadarScan};
use ralf::space::Spherical;

/// Nothing is measured better than so much of what it is at 20 dB, nor worse.
const ERRORS: (f64, f64) = (0.5, 2.2);
/// Noise of an amplitude, dB.
const AMPLITUDE_SIGMA: f64 = 0.7;
/// What a receiver calls 0 dB, so that power is not signal to noise.
const RECEIVER_DB: f64 = 62.0;

/// A detection and what is true of it.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Detection {
    seen: Spherical,
    range_rate: f64,
    rcs_db: f64,
    snr_db: f64,
    pub(crate) truth: Truth,
}

/// Which echoes rise above the floor, as many as the scan has room for, by range.
pub(super) fn detected(
    view: &View<'_>,
    echoes: &[Echo],
    floor: &Floor,
    random: &mut Random,
) -> Vec<Detection> {
    let radar = view.radar;
    let margin = |echo: &Echo| decibel(echo.power) - floor.level_db(echo) - radar.threshold_db;
    let mut above: Vec<(f64, &Echo)> = echoes
        .iter()
        .map(|echo| (margin(echo), echo))
        .filter(|(margin, echo)| *margin > 0.0 && rcs_db(radar, echo) > radar.least_rcs_db)
        .collect();
    match radar.keeps {
        Keeps::Clearest => above.sort_by(|a, b| b.0.total_cmp(&a.0)),
        Keeps::Nearest => above.sort_by(|a, b| a.1.seen.range.total_cmp(&b.1.seen.range)),
        Keeps::Largest => above.sort_by(|a, b| rcs_db(radar, b.1).total_cmp(&rcs_db(radar, a.1))),
    }
    above.truncate(radar.room);
    let mut found = Vec::new();
    for (margin, echo) in above {
        let echo = reflected_by_road(view, confused(view, *echo, margin, random), random);
        found.extend(measured(view, &echo, margin, random));
    }
    found.sort_by(|a, b| a.seen.range.total_cmp(&b.seen.range));
    found
}

fn rcs_db(radar: &RadarModel, echo: &Echo) -> f64 {
    apparent_rcs_db(radar, decibel(echo.power), echo.seen.range, echo.seen.azimuth)
}

/// Angles and ranges scatter with the root of the signal to noise ratio.
fn measured(view: &View<'_>, echo: &Echo, margin_db: f64, random: &mut Random) -> Option<Detection> {
    let radar = view.radar;
    let snr_db = margin_db + radar.threshold_db;
    let error = radar.accuracy * 10.0_f64.powf((20.0 - snr_db) / 20.0).clamp(ERRORS.0, ERRORS.1);
    let seen = Spherical {
        range: echo.seen.range + random.normal(error * radar.cell.range),
        azimuth: echo.seen.azimuth + random.normal(error * radar.cell.azimuth),
        elevation: echo.seen.elevation + random.normal(error * radar.cell.elevation),
    };
    let rate = echo.range_rate + random.normal(error * radar.cell.doppler);
    let next = radar.doppler_interval * if random.chance(0.5) { 1.0 } else { -1.0 };
    let wrong = random.chance(radar.doppler_failure * (-margin_db / 6.0).exp());
    let snr_db = decibel(echo.power) + random.normal(AMPLITUDE_SIGMA);
    let detection = Detection {
        seen,
        range_rate: folded(rate, radar.doppler_interval) + if wrong { next } else { 0.0 },
        rcs_db: apparent_rcs_db(radar, snr_db, seen.range, seen.azimuth) + radar.rcs_offset_db,
        snr_db,
        truth: echo.truth,
    };
    let inside = seen.range > 0.5 * NEAREST && seen.azimuth.abs() <= radar.fov[0] / 2.0;
    inside.then_some(detection)
}

/// The scan as it lies in a file: x, y, z, doppler and amplitudes.
pub(crate) fn radar_scan(
    model: &RadarModel,
    declared: &Radar,
    t_ns: i64,
    detections: &[Detection],
) -> Result<RadarScan, String> {
    let column = |value: &dyn Fn(&Detection) -> f64| {
        detections.iter().map(|found| value(found) as f32).collect::<Vec<f32>>()
    };
    // A radar without elevation lays everything on its own plane.
    let place = |found: &Detection| match model.elevation {
        true => found.seen.to_cartesian(),
        false => Spherical { elevation: 0.0, ..found.seen }.to_cartesian(),
    };
    let mut columns = vec![
        column(&|found| place(found).x),
        column(&|found| place(found).y),
        column(&|found| place(found).z),
        column(&|found| found.range_rate),
    ];
    for amplitude in &model.amplitudes {
        columns.push(column(&|found| match amplitude {
            Amplitude::Rcs => found.rcs_db,
            Amplitude::Snr => found.snr_db,
            Amplitude::Power => found.snr_db + RECEIVER_DB,
        }));
    }
    RadarScan::new(declared, t_ns, columns)
}
