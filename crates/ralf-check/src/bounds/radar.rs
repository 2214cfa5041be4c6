//! A radar's numbers.

use super::out_of_reason;
use crate::doppler::{STANDING, predicted};
use crate::remedy::{EMPTY_FILES, LENGTHS, OTHER_TYPE, Remedy};
use crate::sample::{RadarLook, is_absurd};
use crate::statistics::{median, quantile, wrapped};
use crate::verdict::{Question, State, Verdict};
use ralf::sensors::{Elevation, Radar};
use ralf::space::EgoMotion;
use std::f64::consts::{FRAC_PI_2, PI};

/// Medians of ranges lie within, m: from parking to motorways.
const RANGES: std::ops::Range<f64> = 0.8..200.0;
/// Where a usual median lies, m.
const USUAL_RANGE: f64 = 20.0;
/// Share of detections that may lie outside the field of view: calibrations are rounded.
const OUTSIDE: f64 = 0.1;
/// Share of detections without coordinates that is said, and that is doubted.
const NOT_FINITE: (f64, f64) = (0.01, 0.2);
/// Share of scans that may repeat the one before.
const REPEATED: f64 = 0.05;
/// More than this share of detections with absurd ranges is another data type.
const ABSURD: f64 = 0.2;
/// Fewer detections than this tell nothing of a distribution.
const FEWEST: usize = 30;
/// Elevations that differ by no more are one, rad.
const SAME_ELEVATION: f64 = 1e-4;
/// In fewer scans nothing may be there.
const SCANS: usize = 5;

pub(super) fn judge(radar: &Radar, looks: &[RadarLook], motion: &EgoMotion) -> Vec<Verdict> {
    if let Some(verdict) = other_type(&radar.name, looks) {
        return vec![verdict];
    }
    let mut verdicts = Vec::new();
    let all: Vec<[f64; 3]> = looks.iter().flat_map(|look| &look.spherical).copied().collect();
    verdicts.extend(silent(&radar.name, looks));
    verdicts.extend(repeated(&radar.name, looks));
    verdicts.extend(not_finite(&radar.name, looks));
    verdicts.extend(without_numbers(radar, looks, motion));
    verdicts.extend(sigmas(radar));
    if all.len() < FEWEST {
        let missing = format!("{} detections in {} scans; {FEWEST} are needed", all.len(), looks.len());
        verdicts.push(Verdict::cannot_judge(&radar.name, Question::Bounds, missing));
        return verdicts;
    }
    let told: Vec<[f64; 3]> = looks.iter().flat_map(|look| &look.told).copied().collect();
    let in_degrees = angles(&radar.name, &told);
    if in_degrees.is_empty() {
        verdicts.extend(field_of_view(radar, &all));
    }
    verdicts.extend(in_degrees);
    verdicts.extend(negative(&radar.name, &told));
    verdicts.extend(ranges(&radar.name, &all));
    verdicts.extend(elevation(radar, looks));
    verdicts
}

fn doubt(name: &str, evidence: String, remedy: Option<Remedy>) -> Verdict {
    Verdict::doubt(name, Question::Bounds, evidence, remedy)
}

/// Ranges of which many are none that a radar gives: of float64 read as float32, a quarter and more.
fn other_type(name: &str, looks: &[RadarLook]) -> Option<Verdict> {
    let told: usize = looks.iter().map(|look| look.told.len()).sum();
    let absurd = looks.iter().flat_map(|look| &look.told).filter(|[range, ..]| is_absurd(range)).count();
    if told < FEWEST || (absurd as f64) < ABSURD * told as f64 {
        return None;
    }
    let share = 100.0 * absurd as f64 / told as f64;
    let evidence =
        format!("{share:.0} % of the detections have ranges beyond 1000 km or closer to 0 than 1 um");
    Some(doubt(name, evidence, Some(Remedy::LookInto(OTHER_TYPE))))
}

/// A radar that has detected nothing at all, which none does.
fn silent(name: &str, looks: &[RadarLook]) -> Option<Verdict> {
    let is_silent = looks.len() >= SCANS && looks.iter().all(|look| look.rows == 0);
    let evidence = format!("nothing was detected in {} scans", looks.len());
    let look_into = Remedy::LookInto(EMPTY_FILES);
    is_silent.then(|| doubt(name, evidence, Some(look_into)))
}

fn repeated(name: &str, looks: &[RadarLook]) -> Option<Verdict> {
    let follows = |pair: &&[RadarLook]| pair[1].scan == pair[0].scan + 1 && pair[0].rows > 1;
    let pairs: Vec<&[RadarLook]> = looks.windows(2).filter(follows).collect();
    let same = pairs.iter().filter(|pair| pair[0].digest == pair[1].digest).count();
    if same == 0 || (same as f64) < REPEATED * pairs.len() as f64 {
        return None;
    }
    let evidence = format!(
        "the same scan again in {same} of {} cases: the sensor or its recorder is stuck",
        pairs.len()
    );
    Some(doubt(name, evidence, Some(Remedy::LookInto("leave out the scans that repeat"))))
}

fn not_finite(name: &str, looks: &[RadarLook]) -> Option<Verdict> {
    let rows: usize = looks.iter().map(|look| look.rows).sum();
    let lost: usize = looks.iter().map(|look| look.not_finite).sum();
    let share = lost as f64 / rows.max(1) as f64;
    let evidence = format!("{:.0} % of the detections have no finite coordinates", share * 100.0);
    if share > NOT_FINITE.1 {
        return Some(doubt(name, evidence, None));
    }
    (share > NOT_FINITE.0).then(|| Verdict::new(name, Question::Bounds, State::Fact, evidence))
}

/// Fields that hold no number in any detection. While the vehicle stands, range rates without its motion are the
/// measured ones, and some data sets have them once: as `doppler`.
fn without_numbers(radar: &Radar, looks: &[RadarLook], motion: &EgoMotion) -> Option<Verdict> {
    let rows: usize = looks.iter().map(|look| look.rows).sum();
    let never = |column: usize| looks.iter().all(|look| look.numbers.get(column) == Some(&0));
    let stands = |look: &RadarLook| predicted(motion, &radar.vehicle_from_radar, look.t_ns).norm() < STANDING;
    let is_measured = |name: &str| radar.column(name).is_some_and(|column| !never(column));
    let told_once = is_measured("doppler") && motion.is_known() && looks.iter().all(stands);
    let fields = radar.fields.iter().enumerate();
    let fields = fields.filter(|(_, name)| !(told_once && name.as_str() == "doppler_compensated"));
    let fields = fields.filter(|(column, _)| never(*column));
    let names: Vec<String> = fields.map(|(_, name)| format!("`{name}`")).collect();
    if names.is_empty() || rows < FEWEST {
        return None;
    }
    let verb = if names.len() == 1 { "is" } else { "are" };
    let evidence = format!("{} {verb} not a finite number in any of {rows} detections", names.join(", "));
    let remedy = Remedy::LookInto("its fields may lie elsewhere than is said");
    Some(doubt(&radar.name, evidence, Some(remedy)))
}

/// Ranges that are none.
fn negative(name: &str, told: &[[f64; 3]]) -> Option<Verdict> {
    let negative = told.iter().filter(|row| row[0] < 0.0).count();
    let share = 100.0 * negative as f64 / told.len() as f64;
    let evidence = format!("{share:.1} % of the detections have a range below 0");
    (negative > 0).then(|| doubt(name, evidence, Some(Remedy::LookInto("is `range` another field?"))))
}

/// Angles that are no radians: azimuths of 0 to 2 pi are.
fn angles(name: &str, all: &[[f64; 3]]) -> Vec<Verdict> {
    let mut found = Vec::new();
    for (column, field, largest) in [(1, "azimuth", 2.0 * PI), (2, "elevation", FRAC_PI_2)] {
        let beyond = all.iter().filter(|row| row[column].abs() > largest * 1.001).count();
        if beyond * 100 > all.len() {
            let share = 100.0 * beyond as f64 / all.len() as f64;
            let evidence = format!("{share:.0} % of the detections have |{field}| above {largest:.2} rad");
            found.push(doubt(name, evidence, Some(Remedy::InDegrees(field))));
        }
    }
    found
}

fn field_of_view(radar: &Radar, all: &[[f64; 3]]) -> Vec<Verdict> {
    let azimuth = (1, "fov_azimuth_deg", radar.fov_azimuth, radar.sigma_azimuth);
    let elevation = (2, "fov_elevation_deg", radar.fov_elevation, radar.sigma_elevation);
    let measured = radar.elevation == Elevation::Measured;
    let axes = [Some(azimuth), Some(elevation).filter(|_| measured)];
    let mut found = Vec::new();
    for (column, key, full, sigma) in axes.into_iter().flatten() {
        let angles: Vec<f64> = all.iter().map(|row| row[column]).collect();
        let room = full / 2.0 + 2.0 * sigma.min(0.1);
        let outside = outside(&angles, room);
        if outside > OUTSIDE {
            let evidence = format!(
                "{:.0} % of the detections lie outside {key} = {:.1}",
                outside * 100.0,
                full.to_degrees()
            );
            found.push(doubt(&radar.name, evidence, Some(wider(key, &angles, room))));
        }
    }
    found
}

/// The share of angles beyond a limit to either side, rad.
fn outside(angles: &[f64], limit: f64) -> f64 {
    angles.iter().filter(|angle| angle.abs() > limit).count() as f64 / angles.len() as f64
}

/// A field of view that holds the detections; where all lie aside of it, their axes are others.
fn wider(key: &'static str, angles: &[f64], room: f64) -> Remedy {
    let aside = |side: f64| angles.iter().map(|angle| wrapped(angle - side)).collect::<Vec<f64>>();
    let is_aside = [FRAC_PI_2, -FRAC_PI_2].into_iter().any(|side| outside(&aside(side), room) <= OUTSIDE);
    if is_aside && key == "fov_azimuth_deg" {
        return Remedy::LookInto("x and y look exchanged, or turned by 90 degrees");
    }
    let angles: Vec<f64> = angles.iter().map(|angle| angle.abs()).collect();
    Remedy::Value { key, value: 2.0 * quantile(&angles, 0.99).unwrap_or(0.0).to_degrees() }
}

fn ranges(name: &str, all: &[[f64; 3]]) -> Option<Verdict> {
    let ranges: Vec<f64> = all.iter().map(|row| row[0]).collect();
    let middle = median(&ranges).filter(|middle| !RANGES.contains(middle))?;
    let off = |factor: f64| (middle * factor / USUAL_RANGE).ln().abs();
    let nearest = LENGTHS.iter().map(|(factor, _)| *factor).min_by(|a, b| off(*a).total_cmp(&off(*b)));
    let remedy = nearest.filter(|factor| RANGES.contains(&(middle * factor))).map(Remedy::Positions);
    Some(doubt(name, format!("half of the detections lie beyond {middle:.1} m"), remedy))
}

fn elevation(radar: &Radar, looks: &[RadarLook]) -> Option<Verdict> {
    let always = one_elevation(looks).filter(|_| radar.elevation == Elevation::Measured)?;
    let evidence =
        format!("elevation is said to be measured, and is {:.2} degrees always", always.to_degrees());
    Some(doubt(&radar.name, evidence, Some(Remedy::LookInto("elevation = \"none\" in the rig"))))
}

/// The elevation of detections that all lie in one plane, or on one cone, rad.
pub(crate) fn one_elevation(looks: &[RadarLook]) -> Option<f64> {
    let angles = looks.iter().flat_map(|look| &look.spherical).map(|row| row[2]);
    let angles: Vec<f64> = angles.filter(|angle| angle.is_finite()).collect();
    let [low, high] = [quantile(&angles, 0.01)?, quantile(&angles, 0.99)?];
    (high - low <= SAME_ELEVATION).then_some(low)
}

/// Sigmas, and what a radian taken for a degree (or the other way round) makes of them.
fn sigmas(radar: &Radar) -> Vec<Verdict> {
    let measured = radar.elevation == Elevation::Measured;
    let azimuth = Some(("sigma_azimuth_deg", radar.sigma_azimuth.to_degrees(), 0.03..8.0, 57.3));
    let elevation = Some(("sigma_elevation_deg", radar.sigma_elevation.to_degrees(), 0.03..12.0, 57.3));
    let range = Some(("sigma_range_m", radar.sigma_range, 0.004..3.0, 0.01));
    let rows = [azimuth, elevation.filter(|_| measured), range];
    let doubts = rows.into_iter().flatten().filter_map(|(key, value, usual, factor)| {
        out_of_reason(&radar.name, (key, value), &usual, [value * factor, value / factor])
    });
    doubts.collect()
}
