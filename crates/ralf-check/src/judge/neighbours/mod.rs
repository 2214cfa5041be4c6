//! Whether sensors of a kind see the same where their views overlap.
//!
//! Two that contradict each other don't tell which of them is off. It is said only where other evidence knows one of
//! them: range rates or the LiDAR of radars, the radars of LiDARs.

mod lidars;
mod radars;

use super::alternatives::{clocks, yaws};
use super::case::Case;
use crate::change::SensorChange;
use crate::overlap::Tally;
use crate::verdict::Verdict;

/// By which factor a change has to be better: two radars see the same wall at different spots.
const GAIN: f64 = 1.25;

/// Judges all pairs of radars and of LiDARs, and puts right what is found of one that is known to be off.
pub(super) fn judge(case: &mut Case) -> Vec<Verdict> {
    let mut verdicts = radars::judge(case);
    verdicts.extend(lidars::judge(case));
    verdicts
}

/// What other evidence says of a sensor.
#[derive(Clone, Copy)]
struct Known {
    /// That its direction and its handedness are right.
    direction: bool,
    /// That its clock is.
    clock: bool,
}

impl Known {
    /// The changes that are left open.
    fn open(self) -> Vec<SensorChange> {
        let turned = yaws().chain([SensorChange::mirror()]).filter(|_| !self.direction);
        turned.chain(clocks().filter(|_| !self.clock)).collect()
    }
}

/// The best of the changes that clearly beat what is recorded. A change that moves half of what was seen out of the
/// neighbour's sight says nothing.
fn found(
    now: &Tally,
    changes: Vec<SensorChange>,
    tally: impl Fn(&SensorChange) -> Tally,
) -> Option<(SensorChange, Tally)> {
    super::alternatives::best(now, changes.into_iter(), |_| GAIN, tally)
        .filter(|(_, then)| then.points() > 0.5 * now.points())
}

/// For people: `12 % of 800 obstacles lie beside those of radar_left`.
fn share_in_words(now: &Tally, what: &str, neighbour: &str) -> String {
    let (share, points) = (now.share() * 100.0, now.points());
    format!("{share:.0} % of {points:.0} {what} that {neighbour} should see as well lie beside its own")
}
