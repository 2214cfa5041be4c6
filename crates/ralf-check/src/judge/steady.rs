//! Whether a clock stays the same: where scans were lost whose times stayed, all that come after have the times of
//! earlier ones.

use super::alternatives::clocks;
use super::case::Case;
use crate::change::SensorChange;
use crate::overlap::{Measure, Setup, Tally, overlap};
use crate::remedy::Remedy;
use crate::sample::LidarLook;
use crate::verdict::{Question, Verdict};

/// The first and the last so many of the LiDAR scans are asked apart.
const PART: f64 = 0.4;
/// Offsets that differ by less are a scan's length, ms.
const OTHER_MS: f64 = 200.0;
/// So much later or earlier than the right time fits worse, ms: along rails and walls any time fits.
const FOOT_MS: f64 = 300.0;

/// Judges a LiDAR's clock by all radars, and leaves it out where it doesn't stay: what is asked of others by it is
/// wrong at the begin or at the end.
pub(super) fn of_lidar(case: &mut Case, lidar: usize) -> Option<Verdict> {
    let own: Vec<&LidarLook> = case.lidars.iter().copied().filter(|look| look.lidar == lidar).collect();
    let radars: Vec<usize> = case.radars().collect();
    let tally = |looks: &[&LidarLook], clock: &SensorChange| {
        let mut lidar_changes = case.lidar_changes.clone();
        lidar_changes[lidar] = lidar_changes[lidar].and(clock);
        let setup = Setup { lidars: looks, lidar_changes: &lidar_changes, ..case.setup() };
        let one = |radar: &usize| {
            let looks = &case.sample.radars[*radar];
            overlap(&setup, *radar, looks, &case.radar_changes[*radar], Measure::Beside)
        };
        radars.iter().map(one).fold(Tally::default(), Tally::joined)
    };
    let verdict = doubt(&case.sequence.rig.lidars[lidar].name, changed(&own, tally)?);
    case.lidars.retain(|look| look.lidar != lidar);
    Some(verdict)
}

/// Judges a radar's clock by the LiDARs.
pub(super) fn of_radar(case: &mut Case, radar: usize) -> Option<Verdict> {
    let tally = |looks: &[&LidarLook], clock: &SensorChange| {
        let setup = Setup { lidars: looks, ..case.setup() };
        let change = case.radar_changes[radar].and(clock);
        overlap(&setup, radar, &case.sample.radars[radar], &change, Measure::Beside)
    };
    let mut looks = case.lidars.clone();
    looks.sort_by_key(|look| look.t_ns);
    let verdict = doubt(case.name(radar), changed(&looks, tally)?);
    case.leave_out(radar);
    Some(verdict)
}

/// Offsets at the begin and at the end, ms, where they differ, each part denies the other's, and time is told in both.
fn changed(looks: &[&LidarLook], tally: impl Fn(&[&LidarLook], &SensorChange) -> Tally) -> Option<[f64; 2]> {
    let count = (looks.len() as f64 * PART) as usize;
    let parts = [&looks[..count], &looks[looks.len() - count..]];
    let at = |part: usize, ms: f64| tally(parts[part], &SensorChange::clock(ms));
    let best = |part: usize| {
        let tried = [0.0].into_iter().chain(clocks().map(|clock| clock.clock_ms));
        let tried = tried.map(|ms| (ms, at(part, ms)));
        let (ms, then) = tried.max_by(|a, b| a.1.share().total_cmp(&b.1.share()))?;
        let is_peak = [-FOOT_MS, FOOT_MS].iter().all(|foot| at(part, ms + foot).is_beaten_by(&then));
        is_peak.then_some((ms, then))
    };
    let (first, last) = (best(0)?, best(1)?);
    let denies = |part: usize, own: &Tally, other: f64| at(part, other).is_beaten_by(own);
    let differ = (first.0 - last.0).abs() >= OTHER_MS;
    let is_told = differ && denies(0, &first.1, last.0) && denies(1, &last.1, first.0);
    is_told.then_some([first.0, last.0])
}

fn doubt(name: &str, [first, last]: [f64; 2]) -> Verdict {
    let evidence = format!(
        "radar and LiDAR fit best with its times moved by {first:+.0} ms in the first part, and by {last:+.0} ms in \
         the last"
    );
    let what = "its clock may drift, or scans were lost whose times stayed";
    Verdict::doubt(name, Question::Clock, evidence, Some(Remedy::LookInto(what)))
}
