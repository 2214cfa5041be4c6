//! Radar against radar.

use super::super::alternatives::exact;
use super::super::case::Case;
use super::super::doppler::is_explained;
use super::{Known, found, share_in_words};
use crate::change::SensorChange;
use crate::overlap::{Measure, RadarPair, Side, Tally};
use crate::remedy::Remedy;
use crate::verdict::{Question, Verdict};

/// Clocks that range rates know are right within this, ms.
const CLOCK_MS: f64 = 60.0;

/// Judges the pairs that share enough; one who shares nothing with anybody is told so.
pub(super) fn judge(case: &mut Case) -> Vec<Verdict> {
    let radars: Vec<usize> = case.radars().collect();
    let mut verdicts = Vec::new();
    for radar in &radars {
        let mut best_shared: Option<(usize, Tally)> = None;
        let mut doubted = false;
        for neighbour in radars.iter().filter(|neighbour| *neighbour != radar) {
            let now = pair(case, *radar, *neighbour).tally(&case.radar_changes[*radar]);
            // Each pair is judged once: with the one moved that is known less.
            if now.is_enough() && moves(case, *radar, *neighbour) {
                let verdict = contradiction(case, *radar, *neighbour, &now);
                doubted |= verdict.is_some();
                verdicts.extend(verdict);
            }
            if best_shared.as_ref().is_none_or(|(_, best)| now.points() > best.points()) {
                best_shared = Some((*neighbour, now));
            }
        }
        if !doubted {
            verdicts.extend(best_shared.map(|(neighbour, now)| without_doubt(case, *radar, neighbour, &now)));
        }
    }
    verdicts
}

fn pair<'a>(case: &'a Case, radar: usize, neighbour: usize) -> RadarPair<'a> {
    let side =
        |radar: usize| Side { radar, looks: &case.sample.radars[radar], change: case.radar_changes[radar] };
    RadarPair::new(&case.sequence.rig, &case.motion, side(radar), side(neighbour))
}

/// Whether this one of a pair is moved against the other: the less known one, or the first.
fn moves(case: &Case, radar: usize, neighbour: usize) -> bool {
    let [own, other] = [radar, neighbour].map(|radar| {
        let known = known(case, radar);
        u8::from(known.direction) + u8::from(known.clock)
    });
    own < other || (own == other && radar < neighbour)
}

fn known(case: &Case, radar: usize) -> Known {
    let mount = case.mount(radar);
    let by_lidar = case.overlap(radar, &SensorChange::default(), Measure::Beside).tells();
    let figures = case.doppler(radar, &case.motion, &mount);
    let clock = figures
        .as_ref()
        .and_then(|figures| crate::doppler::clock(&case.fits[radar], &case.motion, &mount, figures));
    Known {
        direction: by_lidar || figures.as_ref().is_some_and(is_explained),
        clock: by_lidar || clock.is_some_and(|clock| clock.is_sharp && clock.offset_ms.abs() < CLOCK_MS),
    }
}

fn contradiction(case: &mut Case, radar: usize, neighbour: usize, now: &Tally) -> Option<Verdict> {
    let own = case.radar_changes[radar];
    let shared = pair(case, radar, neighbour);
    let tally = |change: &SensorChange| shared.tally(&own.and(change));
    let (change, then) = found(now, known(case, radar).open(), tally)?;
    let change = exact(change, |change| shared.tally(&own.and(change)).share());
    let neighbour_is_known = {
        let other = known(case, neighbour);
        if change.clock_ms != 0.0 { other.clock } else { other.direction }
    };
    let name = case.name(neighbour);
    let evidence =
        format!("{}, and {:.0} % otherwise", share_in_words(now, "detections", name), then.share() * 100.0);
    if neighbour_is_known {
        case.radar_changes[radar] = own.and(&change);
        let remedy = Some(Remedy::Sensor(change));
        return Some(Verdict::doubt(case.name(radar), Question::Neighbours, evidence, remedy));
    }
    let evidence = format!(
        "{evidence} ({} against it: {}); which of the two is off can't be told",
        case.name(radar),
        Remedy::Sensor(change).words()
    );
    Some(Verdict::doubt(case.name(radar), Question::Neighbours, evidence, None))
}

fn without_doubt(case: &Case, radar: usize, neighbour: usize, now: &Tally) -> Verdict {
    let name = case.name(radar);
    let evidence = share_in_words(now, "detections", case.name(neighbour));
    if now.tells() {
        return Verdict::good(name, Question::Neighbours, evidence);
    }
    let missing = format!("{evidence}: 150 are needed, and one in ten of them");
    Verdict::cannot_judge(name, Question::Neighbours, missing)
}
