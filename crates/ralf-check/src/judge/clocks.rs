//! Which clock is off, where radars see the vehicle's speed change earlier or later than it is recorded.

use super::case::Case;
use crate::change::{MotionChange, SensorChange};
use crate::doppler::{ClockFigures, clock};
use crate::overlap::Measure;
use crate::remedy::Remedy;
use crate::statistics::median;
use crate::verdict::{Question, State, Verdict};

/// Offsets below this are the scan's own length, ms.
const SMALL_MS: f64 = 60.0;
/// A clear gain: this share of the misfit is left at most, and it is so many standard errors.
const LEFT: f64 = 0.85;
const SIGMAS: f64 = 4.0;
/// Radars agree on an offset within this, ms.
const COMMON_MS: f64 = 80.0;
/// Odometry that is late by less moves nothing by a decimetre between two scans, for speeds change by some m/s per s:
/// a fact. Some vehicles' buses lag by 200 ms.
pub(super) const HARMLESS_MS: f64 = 300.0;

/// Judges all clocks by range rates, and puts right what is found.
pub(super) fn judge(case: &mut Case) -> Vec<Verdict> {
    let known: Vec<(usize, ClockFigures)> =
        case.radars().filter_map(|radar| Some((radar, of_radar(case, radar)?))).collect();
    let late: Vec<(usize, ClockFigures)> =
        known.iter().copied().filter(|(_, figures)| is_clear(figures)).collect();
    let offsets: Vec<f64> = late.iter().map(|(_, figures)| figures.offset_ms).collect();
    let common = median(&offsets).unwrap_or(0.0);
    let is_common = offsets.iter().all(|offset| (offset - common).abs() <= COMMON_MS);
    // One radar of several has a clock of its own; what most of them see alike is the motion's, unless the LiDAR says
    // otherwise.
    let most = late.len() * 5 >= known.len() * 3 && is_common && !late.is_empty();
    if most && !fits_lidar(case, &late, common) && (late.len() > 1 || lidar_can_tell(case, &late)) {
        return vec![motion_is_late(case, &late, common)];
    }
    let mut verdicts = Vec::new();
    for (radar, figures) in late {
        let change = SensorChange::clock(figures.offset_ms.round());
        case.radar_changes[radar] = case.radar_changes[radar].and(&change);
        let remedy = Some(Remedy::Sensor(change));
        verdicts.push(Verdict::doubt(case.name(radar), Question::Clock, in_words(&figures), remedy));
    }
    for (radar, figures) in known.iter().filter(|(_, figures)| !is_clear(figures)) {
        verdicts.push(clear_or_dull(case.name(*radar), figures));
    }
    verdicts
}

fn of_radar(case: &Case, radar: usize) -> Option<ClockFigures> {
    let mount = case.mount(radar);
    let figures = case.doppler(radar, &case.motion, &mount)?;
    clock(&case.fits[radar], &case.motion, &mount, &figures)
}

/// Whether an offset is more than a scan's length, and told by more than chance.
pub(super) fn is_clear(figures: &ClockFigures) -> bool {
    figures.offset_ms.abs() > SMALL_MS && figures.sigmas > SIGMAS && figures.then < LEFT * figures.now
}

/// Whether detections fall on LiDAR points with the offset, where they do not as recorded.
fn fits_lidar(case: &Case, late: &[(usize, ClockFigures)], offset_ms: f64) -> bool {
    let better = |radar: usize| {
        let now = case.overlap(radar, &SensorChange::default(), Measure::Beside);
        now.is_beaten_by(&case.overlap(radar, &SensorChange::clock(offset_ms), Measure::Beside))
    };
    let agreeing = late.iter().filter(|(radar, _)| better(*radar)).count();
    agreeing * 2 > late.len()
}

fn lidar_can_tell(case: &Case, late: &[(usize, ClockFigures)]) -> bool {
    late.iter().any(|(radar, _)| case.overlap(*radar, &SensorChange::default(), Measure::Beside).is_enough())
}

fn in_words(figures: &ClockFigures) -> String {
    format!(
        "its velocities are {:.2} m/s off the vehicle's, and {:.2} m/s when its times are moved by {:+.0} ms",
        figures.now, figures.then, figures.offset_ms
    )
}

/// The motion's times are off by what the radars' seem to be, the other way round.
fn motion_is_late(case: &mut Case, late: &[(usize, ClockFigures)], offset_ms: f64) -> Verdict {
    let own = -offset_ms.round();
    case.motion = MotionChange { clock_ms: own, ..MotionChange::default() }.of(&case.motion);
    let state = if own.abs() <= HARMLESS_MS { State::Fact } else { State::Doubt };
    let misfit =
        |figure: fn(&ClockFigures) -> f64| median(&late.iter().map(|(_, f)| figure(f)).collect::<Vec<_>>());
    let evidence = format!(
        "{} radars see speeds {:.0} ms {} than recorded ({:.2} m/s apart, {:.2} m/s with this)",
        late.len(),
        own.abs(),
        if own < 0.0 { "earlier" } else { "later" },
        misfit(|f| f.now).unwrap_or(0.0),
        misfit(|f| f.then).unwrap_or(0.0)
    );
    Verdict {
        remedy: Some(Remedy::MotionClock(own)),
        ..Verdict::new("motion", Question::Clock, state, evidence)
    }
}

fn clear_or_dull(name: &str, figures: &ClockFigures) -> Verdict {
    if figures.is_sharp && figures.offset_ms.abs() > SMALL_MS {
        let ClockFigures { now, then, offset_ms, .. } = figures;
        let evidence = format!(
            "speeds fit best when its times are moved by {offset_ms:+.0} ms, by too little to be doubted: {now:.2} m/s \
             off as they are, {then:.2} m/s then"
        );
        return Verdict::cannot_judge(name, Question::Clock, evidence);
    }
    if figures.is_sharp {
        let evidence = format!(
            "speeds fit best within {:.0} ms of the motion's clock",
            figures.offset_ms.abs().max(20.0)
        );
        return Verdict::good(name, Question::Clock, evidence);
    }
    let missing = "the speed changes too little: braking or starting is needed";
    Verdict::cannot_judge(name, Question::Clock, missing)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clock_that_fits_best_elsewhere_is_not_in_order() {
        let of = |offset_ms: f64, is_sharp: bool| {
            let figures = ClockFigures { offset_ms, now: 0.10, then: 0.09, sigmas: 2.0, is_sharp };
            clear_or_dull("radar", &figures)
        };
        assert_eq!(of(30.0, true).state, State::Good);
        let far = of(-72.0, true);
        assert_eq!(far.state, State::CannotJudge, "{}", far.evidence);
        assert!(far.evidence.contains("-72 ms"), "{}", far.evidence);
        assert_eq!(of(30.0, false).state, State::CannotJudge);
    }
}
