//! LiDAR against LiDAR.

use super::super::alternatives::exact;
use super::super::case::Case;
use super::{Known, found, share_in_words};
use crate::change::SensorChange;
use crate::overlap::{LidarPair, Measure, Setup, Tally, overlap};
use crate::remedy::Remedy;
use crate::verdict::{Question, Verdict};

/// The radars tell which of two LiDARs is off by so many standard errors.
const CLEARLY: f64 = 3.0;

/// Judges each pair.
pub(super) fn judge(case: &mut Case) -> Vec<Verdict> {
    let count = case.sequence.rig.lidars.len();
    let mut verdicts = Vec::new();
    for first in 0..count {
        for second in first + 1..count {
            verdicts.push(one(case, first, second));
        }
    }
    verdicts
}

fn pair<'a>(case: &'a Case, asked: usize, neighbour: usize) -> LidarPair<'a> {
    let neighbour_change = case.lidar_changes[neighbour];
    let Case { sequence, motion, lidars, .. } = case;
    LidarPair { rig: &sequence.rig, motion, looks: lidars, asked, neighbour, neighbour_change }
}

fn one(case: &mut Case, first: usize, second: usize) -> Verdict {
    let [name, other] = [first, second].map(|lidar| case.sequence.rig.lidars[lidar].name.as_str());
    let open = Known { direction: false, clock: false }.open();
    let now = pair(case, first, second).tally(&case.lidar_changes[first]);
    let evidence = share_in_words(&now, "obstacles", other);
    if !now.is_enough() {
        let missing = format!("{evidence}: 150 are needed");
        return Verdict::cannot_judge(name, Question::Neighbours, missing);
    }
    if best(case, first, second, &now, open.clone()).is_none() {
        return if now.tells() {
            Verdict::good(name, Question::Neighbours, evidence)
        } else {
            Verdict::cannot_judge(name, Question::Neighbours, format!("{evidence}: one in ten is needed"))
        };
    }
    // The one that its change also brings onto the radars' detections is off.
    for (asked, neighbour) in [(first, second), (second, first)] {
        let now = pair(case, asked, neighbour).tally(&case.lidar_changes[asked]);
        if let Some((change, then)) = best(case, asked, neighbour, &now, open.clone())
            && radars_agree(case, asked, &change)
        {
            case.lidar_changes[asked] = case.lidar_changes[asked].and(&change);
            let [name, other] = [asked, neighbour].map(|lidar| case.sequence.rig.lidars[lidar].name.as_str());
            let share = then.share() * 100.0;
            let evidence =
                format!("{}, and {share:.0} % otherwise", share_in_words(&now, "obstacles", other));
            return Verdict::doubt(name, Question::Neighbours, evidence, Some(Remedy::Sensor(change)));
        }
    }
    let evidence = format!("{evidence}, and more otherwise; which of the two is off can't be told");
    Verdict::doubt(name, Question::Neighbours, evidence, None)
}

/// The change of the first that makes it see what the second sees.
fn best(
    case: &Case,
    asked: usize,
    neighbour: usize,
    now: &Tally,
    open: Vec<SensorChange>,
) -> Option<(SensorChange, Tally)> {
    let own = case.lidar_changes[asked];
    let shared = pair(case, asked, neighbour);
    let tally = |change: &SensorChange| shared.tally(&own.and(change));
    let (change, _) = found(now, open, tally)?;
    let change = exact(change, |change| tally(change).share());
    Some((change, tally(&change)))
}

/// Whether the radars' detections lie on a LiDAR's points with the change, and do not without.
fn radars_agree(case: &Case, lidar: usize, change: &SensorChange) -> bool {
    let own: Vec<_> = case.lidars.iter().filter(|look| look.lidar == lidar).copied().collect();
    let tally = |change: SensorChange| {
        let mut changes = case.lidar_changes.clone();
        changes[lidar] = change;
        let setup = Setup { lidars: &own, lidar_changes: &changes, ..case.setup() };
        let one = |radar: usize| {
            overlap(&setup, radar, &case.sample.radars[radar], &case.radar_changes[radar], Measure::Beside)
        };
        case.radars().map(one).fold(Tally::default(), Tally::joined)
    };
    tally(case.lidar_changes[lidar]).sigmas_to(&tally(case.lidar_changes[lidar].and(change))) > CLEARLY
}
