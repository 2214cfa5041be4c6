//! Two radars whose mountings stand in each other's place.

use super::case::Case;
use super::doppler::is_explained;
use crate::change::SensorChange;
use crate::overlap::{Measure, Setup, Tally, overlap};
use crate::remedy::Remedy;
use crate::verdict::{Question, Verdict};

/// Finds pairs that fit each other's mountings and not their own, by range rates, and by the LiDAR where it says
/// something. Without it, all other radars have to be in order: else the sign of all range rates explains it as well.
pub(super) fn judge(case: &Case) -> Vec<Verdict> {
    let radars: Vec<usize> = case.radars().collect();
    for (i, a) in radars.iter().enumerate() {
        for b in &radars[i + 1..] {
            if let Some(evidence) = swapped(case, *a, *b) {
                let verdict = |subject: usize, other: usize| {
                    let remedy = Remedy::SwapWith(case.name(other).to_owned());
                    Verdict::doubt(case.name(subject), Question::Doppler, evidence.clone(), Some(remedy))
                };
                return vec![verdict(*a, *b), verdict(*b, *a)];
            }
        }
    }
    Vec::new()
}

fn swapped(case: &Case, a: usize, b: usize) -> Option<String> {
    let fits = |radar: usize, mount: usize| {
        case.doppler(radar, &case.motion, &case.mount(mount)).as_ref().is_some_and(is_explained)
    };
    if fits(a, a) || fits(b, b) || !fits(a, b) || !fits(b, a) {
        return None;
    }
    let mut rig = case.sequence.rig.clone();
    (rig.radars[a].vehicle_from_radar, rig.radars[b].vehicle_from_radar) =
        (rig.radars[b].vehicle_from_radar, rig.radars[a].vehicle_from_radar);
    let tally = |setup: &Setup| {
        let one = |radar: usize| {
            overlap(setup, radar, &case.sample.radars[radar], &SensorChange::default(), Measure::Beside)
        };
        Tally::joined(one(a), one(b))
    };
    let (now, then) = (tally(&case.setup()), tally(&Setup { rig: &rig, ..case.setup() }));
    let others_fit = || {
        let mut others = case.radars().filter(|radar| ![a, b].contains(radar)).peekable();
        others.peek().is_some() && others.all(|radar| fits(radar, radar))
    };
    let convincing = if now.is_enough() { now.is_beaten_by(&then) } else { others_fit() };
    convincing.then(|| {
        format!(
            "range rates go with the motion in each other's mounting alone; \
             {:.0} % of the detections lie on LiDAR points, {:.0} % when swapped",
            now.share() * 100.0,
            then.share() * 100.0
        )
    })
}
