//! Heights of a radar that measures elevation: its detections are as high as what they lie on. Its elevation may have
//! the other sign or be another field, or it is rolled or pitched.

use super::alternatives::{best, gain_of_one};
use super::case::Case;
use super::places::{PLACE, PLACES, by_place};
use crate::bounds::one_elevation;
use crate::change::SensorChange;
use crate::overlap::{Measure, Tally, overlap};
use crate::remedy::Remedy;
use crate::sample::RadarLook;
use crate::verdict::{Question, State, Verdict};
use ralf::sensors::Elevation;
use ralf::space::Point;

/// Degrees that are tried.
const TILTS: [f64; 6] = [-6.0, -4.0, -2.0, 2.0, 4.0, 6.0];
/// With the other sign so many times as many lie on the road.
const OTHER_SIGN: f64 = 1.3;
/// Elevations that say something have so many times as many as high as low things, and on the road, as those of other
/// detections: right recordings from 0.98 and 3 on, noise 1.0 and 1.1. Both are asked.
const TELLS: (f64, f64) = (1.1, 1.5);
/// Elevations that are told to be no surer than this say as little of heights as noise, rad.
const SURE: f64 = 3.0 * std::f64::consts::PI / 180.0;
/// Elevations of others would have more than this, where all lie in a plane.
const MOST: f64 = 0.6;

/// Judges each radar that measures elevation; nothing is said of those in order. From one place it sees the same few
/// low things in every scan, and how high their strongest spots are is theirs: several places are needed. A LiDAR that
/// is tilted or too high says nothing of heights.
pub(super) fn judge(case: &Case, known: &[Verdict]) -> Vec<Verdict> {
    let is_of_ground =
        |verdict: &Verdict| verdict.state == State::Doubt && verdict.question == Question::Ground;
    let is_told = |radar: &usize| {
        let sensor = &case.sequence.rig.radars[*radar];
        sensor.elevation != Elevation::None && one_elevation(&case.sample.radars[*radar]).is_none()
    };
    if known.iter().any(is_of_ground) {
        let missing = "the height or the tilt of a LiDAR is doubted: it has to be put right before";
        let cannot = |radar| Verdict::cannot_judge(case.name(radar), Question::Lidar, missing);
        return case.radars().filter(is_told).map(cannot).collect();
    }
    let places = by_place(case.lidars.iter().copied().filter(|look| look.lidar == 0), &case.motion).len();
    case.radars().filter(is_told).filter_map(|radar| one(case, radar, places)).collect()
}

fn one(case: &Case, radar: usize, places: usize) -> Option<Verdict> {
    let sensor = &case.sequence.rig.radars[radar];
    if places < PLACES {
        let missing = format!(
            "its roll and pitch are judged by low things seen from {PLACES} places: {:.0} m of driving are needed",
            PLACE * PLACES as f64
        );
        return Some(Verdict::cannot_judge(&sensor.name, Question::Lidar, missing));
    }
    let now = as_high(case, radar, &SensorChange::default());
    let is_sure = sensor.sigma_elevation <= SURE;
    let idle = || is_sure.then(|| idle(case, radar, &now)).flatten();
    if let Some(found) = upside_down(case, radar).or_else(idle) {
        let remedy = Some(Remedy::LookInto(found.what));
        return Some(Verdict::doubt(&sensor.name, Question::Lidar, found.evidence, remedy));
    }
    let (found, then) = tilted(case, radar, &now)?;
    let evidence = as_high_in_words(&now, &then);
    Some(Verdict::doubt(&sensor.name, Question::Lidar, evidence, Some(Remedy::Sensor(found))))
}

/// What else elevations may be.
struct Elsewise {
    what: &'static str,
    evidence: String,
}

fn as_high(case: &Case, radar: usize, change: &SensorChange) -> Tally {
    case.overlap(radar, change, Measure::AsHigh)
}

fn as_high_in_words(now: &Tally, then: &Tally) -> String {
    format!(
        "{:.0} % of the detections are as high as the LiDAR points beside them, and {:.0} % otherwise",
        now.share() * 100.0,
        then.share() * 100.0
    )
}

/// An elevation that says nothing of how high things are, nor of where the road is.
fn idle(case: &Case, radar: usize, now: &Tally) -> Option<Elsewise> {
    let is_idle = |now: &Tally, measure: Measure, tells: f64| {
        let then = read(case, radar, measure, with_elevations_of_others);
        let is_idle = now.is_enough() && then.share() < MOST && now.share() < tells * then.share();
        is_idle.then_some(then)
    };
    let then = is_idle(now, Measure::AsHigh, TELLS.0)?;
    is_idle(&case.overlap(radar, &SensorChange::default(), Measure::OnRoad), Measure::OnRoad, TELLS.1)?;
    let what = "its elevation looks like another field: else elevation = \"none\" in the rig";
    Some(Elsewise { what, evidence: as_high_in_words(now, &then) })
}

/// An elevation that has the other sign: clutter of the road lies above it, and no pitch brings it down.
fn upside_down(case: &Case, radar: usize) -> Option<Elsewise> {
    let pitched = |pitch: f64| case.overlap(radar, &SensorChange::tilt(0.0, pitch), Measure::OnRoad);
    let now = pitched(0.0);
    let other_sign = |look: &RadarLook| look.read_otherwise(|p| Point::new(p.x, p.y, -p.z));
    let then = read(case, radar, Measure::OnRoad, other_sign);
    let is_better = now.is_beaten_by_factor(&then, OTHER_SIGN)
        && TILTS.into_iter().all(|pitch| pitched(pitch).share() < then.share());
    let evidence = format!(
        "{:.0} % of what nothing stands beside lies on the road, and {:.0} % with the other sign",
        now.share() * 100.0,
        then.share() * 100.0
    );
    is_better.then_some(Elsewise { what: "its elevation (or z) looks as if it had the other sign", evidence })
}

fn read(case: &Case, radar: usize, measure: Measure, otherwise: impl Fn(&RadarLook) -> RadarLook) -> Tally {
    let looks: Vec<RadarLook> = case.sample.radars[radar].iter().map(otherwise).collect();
    overlap(&case.setup(), radar, &looks, &case.radar_changes[radar], measure)
}

/// Each detection as far and to the same side, and as high as another one is seen.
fn with_elevations_of_others(look: &RadarLook) -> RadarLook {
    let elevations: Vec<f64> = look.standing.iter().map(|p| p.z.atan2(p.x.hypot(p.y))).collect();
    let mut others = elevations.iter().cycle().skip(elevations.len() / 2);
    look.read_otherwise(|p| {
        let (range, azimuth) = (p.coords.norm(), p.y.atan2(p.x));
        let (up, out) = others.next().copied().unwrap_or_default().sin_cos();
        Point::new(range * out * azimuth.cos(), range * out * azimuth.sin(), range * up)
    })
}

fn tilted(case: &Case, radar: usize, now: &Tally) -> Option<(SensorChange, Tally)> {
    let tally = |change: &SensorChange| as_high(case, radar, change);
    let tilts =
        TILTS.into_iter().flat_map(|tilt| [SensorChange::tilt(tilt, 0.0), SensorChange::tilt(0.0, tilt)]);
    best(now, tilts, gain_of_one, tally)
}
