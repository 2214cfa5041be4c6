//! Which changes are tried, and how the best one is made exact.

use crate::change::SensorChange;
use crate::overlap::Tally;

/// Yaws, degrees; clocks, ms; shifts, m.
const YAWS: [f64; 13] = [-10.0, -7.0, -5.0, -3.0, -2.0, 2.0, 3.0, 5.0, 7.0, 10.0, 90.0, -90.0, 180.0];
const CLOCKS: [f64; 8] = [-400.0, -300.0, -200.0, -100.0, 100.0, 200.0, 300.0, 400.0];
const SHIFTS: [f64; 4] = [-1.0, -0.5, 0.5, 1.0];

/// Turned farther, a radar's detections lie among other things altogether: more of them there may be beside some,
/// degrees.
const FAR_TURN: f64 = 45.0;
/// So far to either side of a place that is the right one much less fits, degrees.
const FOOT: f64 = 10.0;
/// So much later than a time that is the right one much less fits, or as much earlier, ms.
pub(super) const FOOT_MS: f64 = 300.0;

/// Turns by which a sensor looks at something else, degrees.
const ELSEWHERE: [f64; 6] = [-150.0, -90.0, -30.0, 30.0, 90.0, 150.0];

/// Turns by which a sensor looks at something else: what then lies beside points, does so by chance.
pub(super) fn elsewhere() -> impl Iterator<Item = SensorChange> {
    ELSEWHERE.into_iter().map(SensorChange::yaw)
}

/// Yaws that are tried.
pub(super) fn yaws() -> impl Iterator<Item = SensorChange> {
    YAWS.into_iter().map(SensorChange::yaw)
}

/// Clock offsets that are tried.
pub(super) fn clocks() -> impl Iterator<Item = SensorChange> {
    CLOCKS.into_iter().map(SensorChange::clock)
}

/// Shifts that are tried, forward and to the left.
pub(super) fn shifts() -> impl Iterator<Item = SensorChange> {
    let along = SHIFTS.into_iter().map(|metres| SensorChange::shift(metres, 0.0));
    along.chain(SHIFTS.into_iter().map(|metres| SensorChange::shift(0.0, metres)))
}

/// By which factor a change has to be better that several radars ask for alike.
pub(super) const GAIN: f64 = 1.08;

/// By which factor a shift has to be better, or a clock's offset, which is one along the way: either brings what lies
/// beside narrow things, such as clutter before a garage's walls, onto them. Half a metre that is truly missing gains
/// more than this.
pub(super) const GAIN_OF_SHIFT: f64 = 1.3;

/// By which factor a change of a single radar has to be better.
pub(super) fn gain_of_one(change: &SensorChange) -> f64 {
    if change.shift_m == [0.0; 3] && change.clock_ms == 0.0 { GAIN } else { GAIN_OF_SHIFT }
}

/// The change with the best tally, if it beats the present one.
pub(super) fn best(
    now: &Tally,
    changes: impl Iterator<Item = SensorChange>,
    gain: impl Fn(&SensorChange) -> f64,
    tally: impl Fn(&SensorChange) -> Tally,
) -> Option<(SensorChange, Tally)> {
    if !now.is_enough() {
        return None;
    }
    let tried = changes.map(|change| (change, tally(&change)));
    let beating = tried.filter(|(change, then)| now.is_beaten_by_factor(then, gain(change)));
    let beating = beating.filter(|(change, then)| is_peak(change, then, &tally));
    beating.max_by(|a, b| a.1.share().total_cmp(&b.1.share()))
}

/// Whether a change fits better than more of it.
///
/// Of a large turn, or left for right, some degrees to either side: among trees beside a road any fits, and what lies
/// on a lawn comes to lie in the wood on the other side. Of a clock farther away from the recorded time: between walls
/// along the road the nearer a detection is brought to the LiDAR, the more points lie beside it.
fn is_peak(change: &SensorChange, then: &Tally, tally: impl Fn(&SensorChange) -> Tally) -> bool {
    let beats = |more: SensorChange| tally(&change.and(&more)).is_beaten_by(then);
    if change.clock_ms != 0.0 {
        return beats(SensorChange::clock(FOOT_MS.copysign(change.clock_ms)));
    }
    let is_near = change.turn_deg[2].abs() < FAR_TURN && !change.mirrored;
    is_near || [-FOOT, FOOT].into_iter().all(|side| beats(SensorChange::yaw(side)))
}

/// A change of one quantity made exact: the smooth score is climbed in steps that are halved until they matter no more.
pub(super) fn exact(found: SensorChange, score: impl Fn(&SensorChange) -> f64) -> SensorChange {
    let (unit, mut step) = if found.clock_ms != 0.0 {
        (SensorChange::clock(1.0), 50.0)
    } else if found.shift_m[0] != 0.0 {
        (SensorChange::shift(1.0, 0.0), 0.25)
    } else if found.shift_m[1] != 0.0 {
        (SensorChange::shift(0.0, 1.0), 0.25)
    } else if found.turn_deg[2] != 0.0 {
        (SensorChange::yaw(1.0), 1.0)
    } else {
        return found;
    };
    let (last, farthest) = (step / 16.0, 3.0 * step);
    let (mut best, mut highest) = (found, score(&found));
    while step > last {
        let sides = [-step, step].map(|step| best.and(&unit.times(step)));
        let near = |side: &SensorChange| unit.value_in(&side.and(&found.times(-1.0))).abs() <= farthest;
        let next = sides
            .into_iter()
            .filter(near)
            .map(|side| (score(&side), side))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        match next {
            Some((score, side)) if score > highest => (highest, best) = (score, side),
            _ => step /= 2.0,
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tally of six moments, of which so many percent lie on something.
    fn percent(share: f64) -> Tally {
        Tally { moments: (0..6).map(|i| [share + f64::from(i % 2), 100.0]).collect() }
    }

    #[test]
    fn a_large_turn_is_a_peak_and_no_thicket() {
        let best_of = |beside: f64| {
            let tally =
                |change: &SensorChange| percent(if change.turn_deg[2] == 90.0 { 64.0 } else { beside });
            best(&percent(45.0), yaws().filter(|yaw| yaw.turn_deg[2] == 90.0), |_| GAIN, tally)
        };
        assert_eq!(best_of(62.0), None, "as much of it at 80 and at 100 degrees");
        assert_eq!(best_of(30.0).map(|(change, _)| change), Some(SensorChange::yaw(90.0)));
    }

    #[test]
    fn a_clock_is_a_peak_and_no_slope() {
        let best_of = |share: fn(f64) -> f64| {
            let tally = |change: &SensorChange| percent(share(change.clock_ms));
            best(&percent(28.0), clocks(), gain_of_one, tally)
        };
        assert_eq!(best_of(|ms| 28.0 - ms / 30.0), None, "the earlier, the nearer to the LiDAR");
        let peak = best_of(|ms| 40.0 - (ms + 200.0).abs() / 20.0);
        assert_eq!(peak.map(|(change, _)| change), Some(SensorChange::clock(-200.0)));
    }

    #[test]
    fn a_yaw_is_made_exact() {
        let score = |change: &SensorChange| -(change.turn_deg[2] + 4.6).powi(2);
        let found = exact(SensorChange::yaw(-5.0), score);
        assert!((found.turn_deg[2] + 4.6).abs() < 0.1, "{found:?}");
    }
}
