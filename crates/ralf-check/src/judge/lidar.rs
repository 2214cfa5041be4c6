//! Whether a LiDAR is where and when it is said to be: what several radars ask for alike is its fault.

use super::alternatives::{GAIN, best, clocks, exact, shifts, yaws};
use super::case::Case;
use super::doppler::is_aligned;
use crate::change::SensorChange;
use crate::overlap::{Measure, Setup, Tally, overlap};
use crate::remedy::Remedy;
use crate::verdict::{Question, Verdict};

/// A radar takes part when it gains so many standard errors.
const TAKES_PART: f64 = 2.0;

/// Judges each LiDAR, and puts right what is found.
pub(super) fn judge(case: &mut Case) -> Vec<Verdict> {
    (0..case.sequence.rig.lidars.len()).filter_map(|lidar| one(case, lidar)).collect()
}

fn one(case: &mut Case, lidar: usize) -> Option<Verdict> {
    let now = tallies(case, lidar, &SensorChange::default(), Measure::Beside);
    let name = &case.sequence.rig.lidars[lidar].name;
    let judged = now.iter().filter(|tally| tally.is_enough()).count();
    let changes = yaws().chain(shifts()).chain(clocks()).chain([SensorChange::mirror()]);
    let pooled = joined(now.clone());
    if judged < 2 {
        return None;
    }
    let tally = |change: &SensorChange| joined(tallies(case, lidar, change, Measure::Beside));
    let (found, then) = best(&pooled, changes, |_| GAIN, tally)?;
    let changed = tallies(case, lidar, &found, Measure::Beside);
    let gains =
        now.iter().zip(&changed).filter(|(now, then)| now.is_enough() && now.sigmas_to(then) > TAKES_PART);
    let gaining = gains.count();
    if gaining * 5 < judged * 3 || gaining < 2 || is_the_radars_own(case, &found) {
        return None;
    }
    let score = |change: &SensorChange| joined(tallies(case, lidar, change, Measure::Smooth)).share();
    let change = exact(found, score);
    let evidence = format!(
        "{:.0} % of the detections of {gaining} radars lie beside its points, and {:.0} % otherwise",
        pooled.share() * 100.0,
        then.share() * 100.0
    );
    let verdict = Verdict::doubt(name, Question::Lidar, evidence, Some(Remedy::Sensor(change)));
    case.lidar_changes[lidar] = change;
    Some(verdict)
}

/// A yaw that the radars' own range rates ask for as well is not the LiDAR's.
fn is_the_radars_own(case: &Case, found: &SensorChange) -> bool {
    let figures = case.radars().filter_map(|radar| case.doppler(radar, &case.motion, &case.mount(radar)));
    let (aligned, askew): (Vec<_>, Vec<_>) = figures.partition(is_aligned);
    (found.turn_deg[2] != 0.0 || found.mirrored) && askew.len() > aligned.len()
}

/// A tally per radar with the scans of this LiDAR alone.
fn tallies(case: &Case, lidar: usize, change: &SensorChange, measure: Measure) -> Vec<Tally> {
    let mut changes = case.lidar_changes.clone();
    changes[lidar] = changes[lidar].and(change);
    let setup = Setup { lidar_changes: &changes, ..case.setup() };
    let looks = &case.sample.radars;
    let own = |radar: usize| overlap(&setup, radar, &looks[radar], &case.radar_changes[radar], measure);
    case.radars().map(own).collect()
}

fn joined(tallies: Vec<Tally>) -> Tally {
    tallies.into_iter().fold(Tally::default(), Tally::joined)
}
