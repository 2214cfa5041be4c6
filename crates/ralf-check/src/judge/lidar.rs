//! Whether a LiDAR is where and when it is said to be: what several radars ask for alike is its fault.

use super::alternatives::{GAIN, best, clocks, elsewhere, exact, shifts, yaws};
use super::case::Case;
use super::doppler::is_aligned;
use super::places::{PLACES, by_place};
use super::steady;
use crate::change::SensorChange;
use crate::overlap::{Measure, Setup, Tally, changed_motion_overlap, overlap};
use crate::remedy::Remedy;
use crate::sample::LidarLook;
use crate::verdict::{Question, Verdict};

/// A radar takes part when it gains so many standard errors.
const TAKES_PART: f64 = 2.0;

/// Turns that are tried by what stands still: every so many degrees.
const STEP_DEG: i32 = 5;
/// Another direction is the right one where so many times as much stands still, and this share of all at least.
const STANDS_STILL: (f64, f64) = (1.5, 0.5);
/// Of more detections beside a LiDAR's points the radars go with it.
const GO_TOGETHER: f64 = 0.2;
/// Of so few detections beside a LiDAR's points it doesn't see what the radars see.
pub(super) const APART: f64 = 0.02;

/// Judges each LiDAR, and puts right what is found.
pub(super) fn judge(case: &mut Case) -> Vec<Verdict> {
    let mut verdicts = Vec::new();
    for lidar in 0..case.sequence.rig.lidars.len() {
        verdicts.extend(by_motion(case, lidar));
        match steady::of_lidar(case, lidar) {
            Some(verdict) => verdicts.push(verdict),
            None => verdicts.extend(by_radars(case, lidar)),
        }
    }
    verdicts
}

/// What stands still passes a LiDAR against the vehicle's motion; one that is turned sees it pass another way. From one
/// place all that it sees may be a vehicle that goes its own.
fn by_motion(case: &mut Case, lidar: usize) -> Option<Verdict> {
    let recorded = case.sequence.rig.lidars[lidar].vehicle_from_lidar;
    let own: Vec<&LidarLook> = case.lidars.iter().copied().filter(|look| look.lidar == lidar).collect();
    let tally = |change: &SensorChange| changed_motion_overlap(&own, &recorded, change, &case.motion);
    let now = tally(&SensorChange::default());
    let places = by_place(own.iter().copied(), &case.motion).len();
    // No share is larger than all.
    if !now.is_enough() || STANDS_STILL.0 * now.share() >= 1.0 || places < PLACES {
        return None;
    }
    let most = |mirrored: bool| {
        let turns =
            all_around().map(|turn| SensorChange { mirrored, ..turn }).map(|turn| (turn, tally(&turn)));
        turns.max_by(|a, b| a.1.share().total_cmp(&b.1.share()))
    };
    let (turned, mirrored) = (most(false)?, most(true)?);
    // Where the vehicle doesn't turn both are the same, and the radars tell which is right.
    let found = if turned.1.is_beaten_by(&mirrored.1) { [mirrored, turned] } else { [turned, mirrored] };
    let is_right = |(found, then): (SensorChange, Tally)| {
        let change =
            now.is_beaten_by_factor(&then, STANDS_STILL.0).then(|| exact(found, |c| tally(c).share()))?;
        let then = tally(&change);
        let stands = then.share() >= STANDS_STILL.1 && !do_radars_rather_deny(case, lidar, &change);
        stands.then_some((change, then))
    };
    let (change, then) = found.into_iter().find_map(is_right)?;
    let evidence = format!(
        "{:.0} % of what it saw lies on what it sees half a second later, and {:.0} % otherwise",
        now.share() * 100.0,
        then.share() * 100.0
    );
    case.lidar_changes[lidar] = change;
    let name = &case.sequence.rig.lidars[lidar].name;
    Some(Verdict::doubt(name, Question::Motion, evidence, Some(Remedy::Sensor(change))))
}

/// Whether no more of the radars' detections than now would lie beside a LiDAR's points under a change: a lone vehicle
/// that overtakes asks for a turn that nothing else does. Radars that go with the LiDAR may be turned like it, unless
/// range rates know them.
fn do_radars_rather_deny(case: &Case, lidar: usize, change: &SensorChange) -> bool {
    let tally = |change: &SensorChange| joined(tallies(case, lidar, change, Measure::Beside));
    let [now, then] = [SensorChange::default(), *change].map(|change| tally(&change));
    let [aligned, askew] = by_range_rates(case);
    now.is_enough() && then.share() <= now.share() && (now.share() < GO_TOGETHER || aligned > askew)
}

/// All turns.
fn all_around() -> impl Iterator<Item = SensorChange> {
    let half = 180 / STEP_DEG;
    (1 - half..=half).map(|step| SensorChange::yaw(f64::from(step * STEP_DEG)))
}

fn by_radars(case: &mut Case, lidar: usize) -> Option<Verdict> {
    let now = tallies(case, lidar, &SensorChange::default(), Measure::Beside);
    let name = &case.sequence.rig.lidars[lidar].name;
    let judged = now.iter().filter(|tally| tally.is_enough()).count();
    let changes = yaws().chain(shifts()).chain(clocks()).chain([SensorChange::mirror()]);
    let pooled = joined(now.clone());
    // Radars that look elsewhere by their own range rates see something else.
    let looking = case.radars().zip(&now).filter(|(radar, _)| !is_askew(case, *radar));
    let looking = joined(looking.map(|(_, tally)| tally.clone()).collect());
    if looking.is_enough() && looking.share() < APART {
        return Some(apart(name, &looking));
    }
    if judged < 2 {
        return None;
    }
    let tally = |change: &SensorChange| joined(tallies(case, lidar, change, Measure::Beside));
    let (found, then) = best(&pooled, changes, |_| GAIN, tally)?;
    if !then.is_above_chance(&joined(elsewhere().map(|turn| tally(&turn)).collect())) {
        return None;
    }
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
    case.lidar_changes[lidar] = case.lidar_changes[lidar].and(&change);
    Some(verdict)
}

/// Hardly any detection lies beside its points.
fn apart(name: &str, now: &Tally) -> Verdict {
    let share = now.share() * 100.0;
    let evidence = format!("{share:.0} % of {:.0} detections lie beside its points", now.points());
    let what = "does it see what the radars see? Its points may be another frame's or recording's";
    Verdict::doubt(name, Question::Lidar, evidence, Some(Remedy::LookInto(what)))
}

/// A yaw that the radars' own range rates ask for as well is not the LiDAR's.
fn is_the_radars_own(case: &Case, found: &SensorChange) -> bool {
    let [aligned, askew] = by_range_rates(case);
    (found.turn_deg[2] != 0.0 || found.mirrored) && askew > aligned
}

/// Whether a radar's range rates say that it looks elsewhere than it is said to.
fn is_askew(case: &Case, radar: usize) -> bool {
    let figures = case.doppler(radar, &case.motion, &case.mount(radar));
    figures.is_some_and(|figures| !is_aligned(&figures))
}

/// How many radars look where their range rates say, and how many don't.
fn by_range_rates(case: &Case) -> [usize; 2] {
    let figures = case.radars().filter_map(|radar| case.doppler(radar, &case.motion, &case.mount(radar)));
    let (aligned, askew): (Vec<_>, Vec<_>) = figures.partition(is_aligned);
    [aligned.len(), askew.len()]
}

/// A tally per radar with the scans of all LiDARs, of which this one is changed.
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
