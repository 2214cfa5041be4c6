//! Which changes are tried, and how the best one is made exact.

use crate::change::SensorChange;
use crate::overlap::Tally;

/// Yaws, degrees; clocks, ms; shifts, m.
const YAWS: [f64; 13] = [-10.0, -7.0, -5.0, -3.0, -2.0, 2.0, 3.0, 5.0, 7.0, 10.0, 90.0, -90.0, 180.0];
const CLOCKS: [f64; 8] = [-400.0, -300.0, -200.0, -100.0, 100.0, 200.0, 300.0, 400.0];
const SHIFTS: [f64; 4] = [-1.0, -0.5, 0.5, 1.0];

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

/// The change with the best tally, if it beats the present one.
pub(super) fn best(
    now: &Tally,
    changes: impl Iterator<Item = SensorChange>,
    tally: impl Fn(&SensorChange) -> Tally,
) -> Option<(SensorChange, Tally)> {
    if !now.is_enough() {
        return None;
    }
    let tried = changes.map(|change| (change, tally(&change)));
    let beating = tried.filter(|(_, then)| now.is_beaten_by(then));
    beating.max_by(|a, b| a.1.share().total_cmp(&b.1.share()))
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
    let last = step / 16.0;
    let (mut best, mut highest) = (found, score(&found));
    while step > last {
        let sides = [-step, step].map(|step| best.and(&times(&unit, step)));
        let next = sides.into_iter().map(|side| (score(&side), side)).max_by(|a, b| a.0.total_cmp(&b.0));
        match next {
            Some((score, side)) if score > highest => (highest, best) = (score, side),
            _ => step /= 2.0,
        }
    }
    best
}

fn times(unit: &SensorChange, factor: f64) -> SensorChange {
    SensorChange {
        turn_deg: unit.turn_deg.map(|value| value * factor),
        shift_m: unit.shift_m.map(|value| value * factor),
        clock_ms: unit.clock_ms * factor,
        mirrored: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_yaw_is_made_exact() {
        let score = |change: &SensorChange| -(change.turn_deg[2] + 4.6).powi(2);
        let found = exact(SensorChange::yaw(-5.0), score);
        assert!((found.turn_deg[2] + 4.6).abs() < 0.1, "{found:?}");
    }
}
