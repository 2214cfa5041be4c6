//! A LiDAR's numbers: whether they were read as what they are.

use super::out_of_reason;
use crate::remedy::{EMPTY_FILES, LOWEST_BEAM, OTHER_TYPE, Remedy};
use crate::sample::LidarLook;
use crate::statistics::median;
use crate::verdict::{Question, Verdict};
use ralf::sensors::Lidar;

/// More than this share of absurd coordinates is another data type: one in a thousand happens.
const ABSURD: f64 = 0.01;
/// No LiDAR looks up or down by more than 45 degrees with so many of its returns.
const STEEP: f64 = 0.3;
/// Medians of distances lie within, m.
const RANGES: std::ops::Range<f64> = 1.0..150.0;

/// Sigmas of a range lie within, m: of the best and of the cheapest there are, and some more.
const SIGMAS: std::ops::Range<f64> = 0.001..0.5;

/// Beams may look down more steeply than the lowest one is said to by this, degrees: a LiDAR is tilted a little.
const STEEPER_DEG: f64 = 5.0;

pub(super) fn judge(lidar: &Lidar, looks: &[&LidarLook]) -> Vec<Verdict> {
    let mut verdicts = Vec::from_iter(sigma(lidar));
    let of = |figure: fn(&LidarLook) -> f64| {
        median(&looks.iter().map(|look| figure(look)).collect::<Vec<_>>()).unwrap_or(0.0)
    };
    let doubt = |evidence: String, remedy| Verdict::doubt(&lidar.name, Question::Bounds, evidence, remedy);
    let (points, absurd) = (of(|look| look.shape.points as f64), of(|look| look.shape.absurd));
    let (steep, range) = (of(|look| look.shape.steep), of(|look| look.shape.range));
    let returns = of(|look| look.shape.returns);
    if looks.is_empty() || points < 50.0 {
        let missing = format!("{} scans of {points:.0} points; 50 points are needed", looks.len());
        verdicts.push(Verdict::cannot_judge(&lidar.name, Question::Bounds, missing));
    } else if absurd > ABSURD {
        let share = absurd * 100.0;
        let evidence = format!("{share:.0} % of the coordinates are beyond 1000 km or closer to 0 than 1 um");
        verdicts.push(doubt(evidence, Some(Remedy::LookInto(OTHER_TYPE))));
    } else if returns > 0.0 && !RANGES.contains(&range) {
        let factor = [0.01, 0.001].into_iter().find(|factor| RANGES.contains(&(range * factor)));
        verdicts.push(doubt(
            format!("half of the points lie beyond {range:.1} m"),
            factor.map(Remedy::Positions),
        ));
    } else if steep > STEEP {
        let share = steep * 100.0;
        let evidence =
            format!("{share:.0} % of the points lie more than 45 degrees above or below the sensor");
        verdicts.push(doubt(evidence, Some(Remedy::LookInto("its rows have another number of columns"))));
    } else {
        verdicts.extend(lowest_beam(lidar, looks));
    }
    verdicts.extend(broken(lidar, looks, points));
    verdicts
}

/// A sigma of no LiDAR, and what cm or mm taken for m make of it.
fn sigma(lidar: &Lidar) -> Option<Verdict> {
    let value = lidar.sigma_range;
    out_of_reason(&lidar.name, ("sigma_range_m", value), &SIGMAS, [0.01, 0.001].map(|factor| value * factor))
}

/// Beams that look down more steeply than the lowest one: the blind spot, in which cameras alone are asked, would be
/// too large.
fn lowest_beam(lidar: &Lidar, looks: &[&LidarLook]) -> Option<Verdict> {
    let steepest: Vec<f64> = looks.iter().filter_map(|look| look.steepest).collect();
    let (seen, told) = (median(&steepest)?.atan().to_degrees(), lidar.lowest_beam.to_degrees());
    if seen < told + STEEPER_DEG {
        return None;
    }
    let evidence =
        format!("{LOWEST_BEAM} = {told:.3}, and its points lie as steeply as {seen:.1} degrees below it");
    let in_radians = Some(told.to_degrees()).filter(|degrees| (degrees - seen).abs() < STEEPER_DEG);
    let remedy = Remedy::Value { key: LOWEST_BEAM, value: in_radians.unwrap_or(seen) };
    Some(Verdict::doubt(&lidar.name, Question::Bounds, evidence, Some(remedy)))
}

/// What a broken copy or a stuck sensor leaves; `points` are the usual number of a scan.
fn broken(lidar: &Lidar, looks: &[&LidarLook], points: f64) -> impl Iterator<Item = Verdict> {
    let doubt = |evidence: String, look_into| {
        Verdict::doubt(&lidar.name, Question::Bounds, evidence, Some(Remedy::LookInto(look_into)))
    };
    let silent = looks.iter().filter(|look| look.shape.returns == 0.0).count();
    let nothing = (silent > 0).then(|| {
        let evidence = format!("nothing came back in {silent} of {} scans", looks.len());
        doubt(evidence, EMPTY_FILES)
    });
    let same = looks.windows(2).filter(|pair| pair[0].digest == pair[1].digest && points >= 50.0).count();
    let stuck = (same > 0).then(|| {
        let evidence = format!("the same scan again in {same} of {} cases: it is stuck", looks.len() - 1);
        doubt(evidence, "leave out the scans that repeat")
    });
    nothing.into_iter().chain(stuck)
}
