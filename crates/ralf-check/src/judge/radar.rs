//! Whether a radar is where and when it is said to be: by its range rates, and by the LiDAR.

use super::alternatives::{best, clocks, exact, gain_of_one, shifts, yaws};
use super::case::{Case, SCANS};
use super::doppler::{COMPENSATED, RATIO, in_words, is_aligned, is_explained};
use super::motion::correct_range_rates;
use super::scale;
use super::steady;
use super::swapped;
use super::unseen;
use crate::change::SensorChange;
use crate::doppler::{DopplerFigures, Timed, compare};
use crate::overlap::{Measure, Tally};
use crate::remedy::{Remedy, SPEEDS};
use crate::statistics::wrapped;
use crate::verdict::{Question, State, Verdict};
use nalgebra::Vector2;
use std::f64::consts::PI;

/// A direction that is off by more is no mounting that slipped, degrees: it may be mirrored.
const SLIPPED_DEG: f64 = 12.0;
/// Exchanged axes leave less than this share of what is left with another yaw, a mirror of what is left with another
/// sign.
const EXCHANGED_GAIN: f64 = 0.6;
/// No more than this is what walls do, m.
const SMALL_SHIFT: f64 = 0.5;
/// Scans of a standing vehicle whose world moves.
pub(super) const CREEPING: usize = 3;

/// Judges each radar, and puts right what is found.
pub(super) fn judge(case: &mut Case) -> Vec<Verdict> {
    let mut verdicts = swapped::judge(case);
    let swapped: Vec<String> = verdicts.iter().map(|verdict| verdict.subject.clone()).collect();
    let radars: Vec<usize> = case.radars().collect();
    for radar in radars {
        if !swapped.iter().any(|name| name == case.name(radar)) {
            verdicts.push(by_range_rates(case, radar));
            verdicts.extend(scale::judge(case, radar).or_else(|| steady::of_radar(case, radar)));
            if case.radars().any(|fit| fit == radar) {
                verdicts.push(by_lidar(case, radar));
            }
        }
    }
    verdicts
}

fn by_range_rates(case: &mut Case, radar: usize) -> Verdict {
    let name = case.name(radar);
    let creeping = crate::doppler::creeping(&case.fits[radar], &case.motion, &case.mount(radar));
    if creeping >= CREEPING {
        let evidence = format!("the world moves in {creeping} scans in which the vehicle is said to stand");
        return Verdict::doubt(name, Question::Doppler, evidence, None);
    }
    let Some(figures) = case.doppler(radar, &case.motion, &case.mount(radar)) else {
        return Verdict::cannot_judge(name, Question::Doppler, missing(case, radar));
    };
    if is_explained(&figures) {
        return Verdict::good(name, Question::Doppler, in_words(&figures));
    }
    let remedy = remedy(case, radar, &figures);
    match &remedy {
        Some(Remedy::Doppler(factor)) => correct_range_rates(&mut case.fits[radar], *factor),
        Some(Remedy::Sensor(change)) => case.radar_changes[radar] = case.radar_changes[radar].and(change),
        Some(Remedy::Exchanged) => case.leave_out(radar),
        _ => {}
    }
    Verdict::doubt(name, Question::Doppler, in_words(&figures), remedy)
}

fn missing(case: &Case, radar: usize) -> String {
    let sensor = &case.sequence.rig.radars[radar];
    if sensor.column("doppler").is_none() {
        return "raw range rates are needed: a field `doppler`".into();
    }
    let told =
        format!("{} of {} scans tell a velocity", case.fits[radar].len(), case.sample.radars[radar].len());
    let needed = "ten scans at more than 1 m/s are needed in which three in ten detections stand still";
    let few_stand = compare(&case.fits[radar], &case.motion, &case.mount(radar)).filter(|f| f.scans >= SCANS);
    let why = few_stand.map_or_else(String::new, |figures| {
        let share = figures.inliers * 100.0;
        format!(", in which {share:.0} % of the detections agree (are range rates what `doppler` holds?)")
    });
    format!("{told}{why}: {needed}")
}

/// What makes range rates go with the motion.
fn remedy(case: &Case, radar: usize, figures: &DopplerFigures) -> Option<Remedy> {
    let (ratio, angle) = (figures.ratio.value, figures.angle.value);
    if ratio < COMPENSATED
        && figures.inliers > 0.4
        && !SPEEDS
            .iter()
            .any(|(unit, _)| (ratio * unit - 1.0).abs() < 0.05 || (ratio / unit - 1.0).abs() < 0.05)
    {
        return Some(Remedy::LookInto(
            "range rates look like those without the vehicle's motion (doppler_compensated)",
        ));
    }
    if !RATIO.contains(&ratio) {
        let known = SPEEDS.iter().map(|(unit, _)| *unit).chain(SPEEDS.iter().map(|(unit, _)| 1.0 / unit));
        let factor = known.into_iter().find(|unit| RATIO.contains(&(ratio * unit)));
        return is_aligned(figures).then_some(factor.map(Remedy::Doppler)).flatten();
    }
    let turned = SensorChange::yaw((-angle.to_degrees() * 10.0).round() / 10.0);
    let mirrored = Some(SensorChange::mirror()).filter(|_| misfit(case, radar, with_mirror).is_some());
    let exchanged = Some(SensorChange::exchange()).filter(|_| misfit(case, radar, with_exchange).is_some());
    if angle.abs().to_degrees() <= SLIPPED_DEG {
        // In turns a mirrored radar that looks ahead seems to look aside.
        let is_open = mirrored.is_some() || exchanged.is_some();
        let all = [Some(turned), mirrored, exchanged].into_iter().flatten();
        let found = is_open.then(|| by_overlap(case, radar, all)).flatten();
        return Some(of_change(found.unwrap_or(turned)));
    }
    let other_sign = wrapped(angle - PI).abs() < SLIPPED_DEG.to_radians();
    Some(of_large_angles(case, radar, [Some(turned), mirrored, exchanged], other_sign))
}

/// A direction that is far off: turned, mirrored, x and y exchanged, or the range rates have the other sign. The LiDAR
/// tells, where it can.
fn of_large_angles(
    case: &Case,
    radar: usize,
    changes: [Option<SensorChange>; 3],
    other_sign: bool,
) -> Remedy {
    let found = by_overlap(case, radar, changes.into_iter().flatten());
    match (found, other_sign, changes) {
        (Some(change), _, _) => of_change(change),
        (None, true, [_, Some(mirrored), _]) if is_rather_mirrored(case, radar) => Remedy::Sensor(mirrored),
        (None, true, _) => Remedy::Doppler(-1.0),
        (None, false, [_, Some(mirrored), _]) => Remedy::Sensor(mirrored),
        (None, false, [Some(turned), _, Some(_)]) if is_rather_exchanged(case, radar, &turned) => {
            Remedy::Exchanged
        }
        (None, false, [turned, ..]) => Remedy::Sensor(turned.unwrap_or_default()),
    }
}

fn of_change(change: SensorChange) -> Remedy {
    if change == SensorChange::exchange() { Remedy::Exchanged } else { Remedy::Sensor(change) }
}

/// Whether range rates alone tell that a radar that looks aside is mirrored and its range rates have no other sign: in
/// turns of the vehicle.
fn is_rather_mirrored(case: &Case, radar: usize) -> bool {
    let [mirrored, negated] = [with_mirror, with_other_sign].map(|read| misfit(case, radar, read));
    mirrored.is_some_and(|mirrored| negated.is_none_or(|negated| mirrored < EXCHANGED_GAIN * negated))
}

/// Whether range rates alone tell that x and y are exchanged and the radar isn't turned: in turns of the vehicle.
fn is_rather_exchanged(case: &Case, radar: usize, turned: &SensorChange) -> bool {
    let turned = case.doppler(radar, &case.motion, &turned.mount(&case.mount(radar)));
    let misfit = misfit(case, radar, with_exchange);
    misfit.zip(turned).is_some_and(|(misfit, turned)| misfit < EXCHANGED_GAIN * turned.off)
}

/// The change that the LiDAR asks for.
fn by_overlap(
    case: &Case,
    radar: usize,
    changes: impl IntoIterator<Item = SensorChange>,
) -> Option<SensorChange> {
    let tally = |change: &SensorChange| case.overlap(radar, change, Measure::Beside);
    let now = tally(&SensorChange::default());
    best(&now, changes.into_iter(), gain_of_one, tally).map(|(change, _)| change)
}

/// What is left of range rates, m/s, where velocities in the radar's frame are read otherwise; `None` where that
/// doesn't explain them.
fn misfit(case: &Case, radar: usize, read: fn(Vector2<f64>) -> Vector2<f64>) -> Option<f64> {
    let otherwise = |timed: &Timed| {
        let mut timed = *timed;
        timed.fit.velocity = read(timed.fit.velocity);
        timed
    };
    let fits: Vec<Timed> = case.fits[radar].iter().map(otherwise).collect();
    let figures = compare(&fits, &case.motion, &case.mount(radar));
    figures.filter(is_explained).map(|figures| figures.off)
}

fn with_mirror(velocity: Vector2<f64>) -> Vector2<f64> {
    Vector2::new(velocity.x, -velocity.y)
}

fn with_other_sign(velocity: Vector2<f64>) -> Vector2<f64> {
    -velocity
}

fn with_exchange(velocity: Vector2<f64>) -> Vector2<f64> {
    velocity.yx()
}

fn by_lidar(case: &mut Case, radar: usize) -> Verdict {
    let name = case.name(radar);
    let tally = |change: &SensorChange| case.overlap(radar, change, Measure::Beside);
    let now = tally(&SensorChange::default());
    if !now.is_enough() {
        let missing = format!(
            "{} detections within 40 m were measured together with a LiDAR scan: 150 are needed",
            now.points()
        );
        return Verdict::cannot_judge(name, Question::Lidar, missing);
    }
    let elsewhere = case.elsewhere(radar);
    let found = best(&now, allowed(case, radar).into_iter(), gain_of_one, tally);
    let is_its_own = |(change, then): &(SensorChange, Tally)| {
        then.is_above_chance(&elsewhere) && !is_of_the_walls(case, radar, change)
    };
    let Some((found, then)) = found.filter(is_its_own) else {
        return unseen::judge(case, radar, &now).unwrap_or_else(|| same_world(&now, &elsewhere, name));
    };
    if found == SensorChange::exchange() {
        case.leave_out(radar);
        return Verdict::doubt(name, Question::Lidar, in_share(&now, Some(&then)), Some(Remedy::Exchanged));
    }
    let change = exact(found, |change| case.overlap(radar, change, Measure::Smooth).share());
    let verdict =
        Verdict::doubt(name, Question::Lidar, in_share(&now, Some(&then)), Some(Remedy::Sensor(change)));
    case.radar_changes[radar] = case.radar_changes[radar].and(&change);
    Verdict { state: State::Doubt, ..verdict }
}

/// Whether a small shift to a side is that of walls on both sides, before which radars hear things that a LiDAR doesn't
/// see: another radar asks for the opposite then.
fn is_of_the_walls(case: &Case, radar: usize, change: &SensorChange) -> bool {
    let [_, aside, _] = change.shift_m;
    let opposite = SensorChange::shift(0.0, -aside);
    let tally = |other: usize, change: &SensorChange| case.overlap(other, change, Measure::Beside);
    let asks = |other: usize| tally(other, &SensorChange::default()).is_beaten_by(&tally(other, &opposite));
    aside != 0.0 && aside.abs() <= SMALL_SHIFT && case.radars().filter(|other| *other != radar).any(asks)
}

/// As recorded, more has to lie beside LiDAR points than where the radar looks elsewhere.
fn same_world(now: &Tally, elsewhere: &Tally, name: &str) -> Verdict {
    let evidence = in_share(now, None);
    if now.is_above_chance(elsewhere) {
        return Verdict::good(name, Question::Lidar, evidence);
    }
    let chance = elsewhere.share() * 100.0;
    let evidence = format!(
        "{evidence}, and {chance:.0} % where it looks elsewhere: nothing tells one place from another"
    );
    Verdict::cannot_judge(name, Question::Lidar, evidence)
}

fn in_share(now: &Tally, then: Option<&Tally>) -> String {
    let share =
        format!("{:.0} % of {:.0} detections lie beside LiDAR points", now.share() * 100.0, now.points());
    then.map_or_else(|| share.clone(), |then| format!("{share}, and {:.0} % otherwise", then.share() * 100.0))
}

/// The changes that range rates leave open: no yaw where they have none, no clock where speeds fall upon each other.
fn allowed(case: &Case, radar: usize) -> Vec<SensorChange> {
    let figures = case.doppler(radar, &case.motion, &case.mount(radar));
    let known_yaw = figures.as_ref().is_some_and(is_explained);
    let known_clock = figures.is_some_and(|figures| {
        crate::doppler::clock(&case.fits[radar], &case.motion, &case.mount(radar), &figures)
            .is_some_and(|clock| clock.is_sharp && clock.offset_ms.abs() < 60.0)
    });
    let mut changes: Vec<SensorChange> = shifts().chain([SensorChange::mirror()]).collect();
    if !known_yaw {
        changes.extend(yaws());
    }
    if !known_yaw || misfit(case, radar, with_exchange).is_some() {
        changes.push(SensorChange::exchange());
    }
    if !known_clock {
        changes.extend(clocks());
    }
    changes
}
