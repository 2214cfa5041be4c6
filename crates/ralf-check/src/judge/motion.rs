//! Units and signs of the vehicle's motion, and of all radars' range rates together: one is right where the other is
//! wrong.

use super::case::Case;
use super::doppler::is_explained;
use crate::change::MotionChange;
use crate::doppler::{Timed, Turning, turning};
use crate::overlap::{Tally, motion_overlap, radar_motion_overlap};
use crate::remedy::{Remedy, SPEEDS};
use crate::sample::RadarLook;
use crate::verdict::{Question, Verdict};
use ralf::space::EgoMotion;

/// What a yaw rate is mistaken for.
pub(super) const YAW_RATES: [f64; 3] = [-1.0, std::f64::consts::PI / 180.0, 180.0 / std::f64::consts::PI];
/// Another factor of the yaw rate is better when it leaves less than this share of the misfit, and takes away at
/// least so many rad/s: 0.02 rad/s on a lever of 3 m are 0.06 m/s, what a scan's range rates just tell.
pub(super) const YAW_RATE_GAIN: (f64, f64) = (0.6, 0.02);
/// Of two motions, one is clearly better by so many standard errors.
const CLEARLY: f64 = 2.0;
/// A factor is a unit's within this share.
const UNIT: f64 = 0.4;
/// Speeds this share higher and lower than the right one fit worse.
const BESIDE: f64 = 0.3;

/// Motions by which less of what a LiDAR saw lies on what it sees later say nothing, for no other one fits.
const FITS: f64 = 0.3;

/// Judges the motion, and puts right what is found for those who come after.
pub(super) fn judge(case: &mut Case) -> Vec<Verdict> {
    let changes: Vec<MotionChange> = candidates().collect();
    let explained: Vec<usize> =
        changes.iter().map(|change| count_explained(case, &change.of(&case.motion))).collect();
    let lidar: Vec<Tally> =
        changes.iter().map(|change| motion_overlap(&case.lidars, &change.of(&case.motion))).collect();
    let most = explained.iter().copied().max().unwrap_or(0);
    let by_doppler = (0..changes.len()).find(|i| explained[*i] == most).unwrap_or(0);
    let by_lidar = best(&lidar).filter(|found| is_peak(case, &changes[*found], &lidar[*found]));
    if by_doppler != 0 {
        return contradiction(case, &changes[by_doppler], [&lidar[0], &lidar[by_doppler]], most);
    }
    if let Some(found) = by_lidar.filter(|_| explained[0] == 0) {
        return vec![blame_motion(case, &changes[found], overlap_evidence(&lidar[0], &lidar[found]))];
    }
    if let Some(verdict) = yaw_rate(case) {
        return vec![verdict];
    }
    vec![agreement(case, explained[0], &lidar[0])]
}

/// As recorded, and with what is often mistaken.
fn candidates() -> impl Iterator<Item = MotionChange> {
    let speeds = [-1.0].into_iter().chain(SPEEDS.iter().map(|(factor, _)| *factor)).map(MotionChange::speed);
    [MotionChange::default()].into_iter().chain(speeds).chain(YAW_RATES.map(MotionChange::yaw_rate))
}

/// How many radars a motion leaves without a doubt.
pub(super) fn count_explained(case: &Case, motion: &EgoMotion) -> usize {
    let figures = case.radars().filter_map(|radar| case.doppler(radar, motion, &case.mount(radar)));
    figures.filter(is_explained).count()
}

/// The change whose tally is best, if it beats the first.
fn best(tallies: &[Tally]) -> Option<usize> {
    let beating = (1..tallies.len()).filter(|i| tallies[0].is_beaten_by(&tallies[*i]));
    beating.max_by(|a, b| tallies[*a].share().total_cmp(&tallies[*b].share()))
}

/// Whether another speed fits better than a little more of it, a little less and none at all. Along guard rails and
/// walls any speed fits, the lowest best; and to one at which others drive, much does.
fn is_peak(case: &Case, change: &MotionChange, then: &Tally) -> bool {
    let fits_worse = |part: f64| {
        let speed = MotionChange::speed(part * change.speed);
        motion_overlap(&case.lidars, &speed.of(&case.motion)).is_beaten_by(then)
    };
    change.speed == 1.0 || [0.0, 1.0 - BESIDE, 1.0 + BESIDE].into_iter().all(fits_worse)
}

fn overlap_evidence(now: &Tally, then: &Tally) -> String {
    format!(
        "{:.0} % of what was seen lies on what is seen half a second later, and {:.0} % otherwise",
        now.share() * 100.0,
        then.share() * 100.0
    )
}

/// Range rates and motion contradict each other by a factor or a sign. Things that stand still decide who is wrong.
fn contradiction(case: &mut Case, change: &MotionChange, lidar: [&Tally; 2], radars: usize) -> Vec<Verdict> {
    let changed = change.of(&case.motion);
    let (now, then) = decide(case, &changed, lidar);
    let evidence = format!("range rates of {radars} radars contradict it; {}", overlap_evidence(&now, &then));
    if now.sigmas_to(&then) > CLEARLY || (change.yaw_rate != 1.0 && then.sigmas_to(&now) < CLEARLY) {
        return vec![blame_motion(case, change, evidence)];
    }
    if change.yaw_rate != 1.0 {
        // Radars that are mirrored see turns the other way round.
        return vec![Verdict::good("motion", Question::Motion, overlap_evidence(&now, &then))];
    }
    let mut verdicts = Vec::new();
    for radar in case.radars().collect::<Vec<_>>() {
        let figures = case.doppler(radar, &changed, &case.mount(radar));
        if figures.as_ref().is_some_and(is_explained) {
            let factor = 1.0 / change.speed;
            correct_range_rates(&mut case.fits[radar], factor);
            verdicts.push(Verdict::doubt(
                case.name(radar),
                Question::Doppler,
                format!("its range rates contradict the vehicle's motion; {}", overlap_evidence(&now, &then)),
                Some(Remedy::Doppler(factor)),
            ));
        }
    }
    verdicts.push(Verdict::good("motion", Question::Motion, overlap_evidence(&now, &then)));
    verdicts
}

/// Tallies as recorded and changed: of the LiDARs, or of the radars themselves where these tell too little.
fn decide(case: &Case, changed: &EgoMotion, lidar: [&Tally; 2]) -> (Tally, Tally) {
    if lidar[0].is_enough() {
        return (lidar[0].clone(), lidar[1].clone());
    }
    let all = |motion: &EgoMotion| {
        let one = |radar: usize| radar_motion_overlap(&case.sample.radars[radar], &case.mount(radar), motion);
        case.radars().map(one).fold(Tally::default(), Tally::joined)
    };
    (all(&case.motion), all(changed))
}

/// Range rates times a factor: velocities are proportional to them.
pub(super) fn correct_range_rates(fits: &mut [Timed], factor: f64) {
    fits.iter_mut().for_each(|timed| timed.fit.velocity *= factor);
}

fn blame_motion(case: &mut Case, change: &MotionChange, evidence: String) -> Verdict {
    let change = match change.yaw_rate {
        1.0 => *change,
        unit => MotionChange::yaw_rate(measured(case, unit)),
    };
    case.motion = change.of(&case.motion);
    let remedy =
        if change.speed == 1.0 { Remedy::YawRate(change.yaw_rate) } else { Remedy::Speed(change.speed) };
    Verdict::doubt("motion", Question::Motion, evidence, Some(remedy))
}

/// The yaw rate by the radars' range rates in turns.
fn yaw_rate(case: &mut Case) -> Option<Verdict> {
    let trusted = |radar: &usize| {
        case.doppler(*radar, &case.motion, &case.mount(*radar)).as_ref().is_some_and(is_explained)
    };
    let turning = seen_turning(case, case.radars().filter(trusted).collect());
    let now = turning.misfit(1.0);
    let better = YAW_RATES
        .into_iter()
        .map(|factor| (factor, turning.misfit(factor)))
        .min_by(|a, b| a.1.total_cmp(&b.1))
        .filter(|(_, then)| *then < YAW_RATE_GAIN.0 * now && now - then > YAW_RATE_GAIN.1)?;
    let evidence = format!(
        "range rates see turns that are {:.3} rad/s off the recorded ones, and {:.3} rad/s otherwise",
        now, better.1
    );
    let change = MotionChange::yaw_rate(better.0);
    let [told, changed] =
        [&case.motion, &change.of(&case.motion)].map(|motion| motion_overlap(&case.lidars, motion));
    (changed.sigmas_to(&told) < CLEARLY).then(|| blame_motion(case, &change, evidence))
}

fn seen_turning(case: &Case, radars: Vec<usize>) -> Turning {
    let mounts: Vec<_> = radars.iter().map(|radar| case.mount(*radar)).collect();
    let looks: Vec<&[RadarLook]> = radars.iter().map(|radar| case.sample.radars[*radar].as_slice()).collect();
    turning(&mounts, &looks, &case.motion)
}

/// A factor of the yaw rate, measured: the unit that it was taken for, or else what fits.
fn measured(case: &Case, unit: f64) -> f64 {
    let factor = seen_turning(case, case.radars().collect()).factor();
    // Without range rates nothing is measured.
    let is_told = factor.is_finite() && factor > 0.0;
    let is_unit = unit < 0.0 || !is_told || (factor / unit - 1.0).abs() < UNIT;
    if is_unit { unit } else { (factor * 1000.0).round() / 1000.0 }
}

fn agreement(case: &Case, explained: usize, lidar: &Tally) -> Verdict {
    let of_lidar = format!(
        "{:.0} % of what the LiDAR saw lies on what it sees half a second later",
        lidar.share() * 100.0
    );
    match (explained, lidar.is_enough()) {
        (0, false) => {
            let scans = case.fits.iter().map(Vec::len).sum::<usize>();
            let missing = format!(
                "{scans} radar scans tell a velocity and {} LiDAR points are seen twice: raw range rates (field \
                 `doppler`) of a vehicle that moves are needed, or LiDAR scans half a second apart",
                lidar.points()
            );
            Verdict::cannot_judge("motion", Question::Motion, missing)
        }
        // Another motion would have to fit better, and none that is tried does: it may be none of these.
        (0, true) if lidar.share() < FITS => Verdict::cannot_judge("motion", Question::Motion, of_lidar),
        (0, true) => Verdict::good("motion", Question::Motion, of_lidar),
        (radars, false) => {
            Verdict::good("motion", Question::Motion, format!("range rates of {radars} radars go with it"))
        }
        (radars, true) => {
            let evidence = format!("range rates of {radars} radars go with it; {of_lidar}");
            Verdict::good("motion", Question::Motion, evidence)
        }
    }
}
