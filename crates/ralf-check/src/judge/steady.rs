//! Whether a clock stays the same: where scans were lost whose times stayed, all that come after have the times of
//! earlier ones.

use super::alternatives::{FOOT_MS, GAIN_OF_SHIFT, clocks, shifts, yaws};
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
/// What it may be; of an only radar the LiDAR's as well.
const ITS_OWN: &str = "its clock may drift, or scans were lost whose times stayed";
const OR_LIDARS: &str = "its clock or a LiDAR's may drift, or scans of one were lost whose times stayed";

/// Judges a LiDAR's clock by all radars, and leaves it out where it doesn't stay: what is asked of others by it is
/// wrong at the begin or at the end. Three in five of them have to say so, two at least: else it is the radars'.
pub(super) fn of_lidar(case: &mut Case, lidar: usize) -> Option<Verdict> {
    let own: Vec<&LidarLook> = case.lidars.iter().copied().filter(|look| look.lidar == lidar).collect();
    let radars: Vec<usize> = case.radars().collect();
    let tally = |radars: &[usize], looks: &[&LidarLook], change: &SensorChange| {
        let mut lidar_changes = case.lidar_changes.clone();
        lidar_changes[lidar] = lidar_changes[lidar].and(change);
        let setup = Setup { lidars: looks, lidar_changes: &lidar_changes, ..case.setup() };
        let one = |radar: &usize| {
            let looks = &case.sample.radars[*radar];
            overlap(&setup, *radar, looks, &case.radar_changes[*radar], Measure::Beside)
        };
        radars.iter().map(one).fold(Tally::default(), Tally::joined)
    };
    let found = changed(&own, |looks, change| tally(&radars, looks, change))?;
    let is_enough = |radar: &&usize| tally(&[**radar], &own, &SensorChange::default()).is_enough();
    let judged: Vec<usize> = radars.iter().filter(is_enough).copied().collect();
    let says_so = |radar: &&usize| {
        clocks_of_parts(&own, |looks, change| tally(&[**radar], looks, change))
            .is_some_and(|own| is_alike(own, found))
    };
    let saying = judged.iter().filter(says_so).count();
    if saying * 5 < judged.len() * 3 || saying < 2 {
        return None;
    }
    let verdict = doubt(&case.sequence.rig.lidars[lidar].name, found, ITS_OWN);
    case.lidars.retain(|look| look.lidar != lidar);
    Some(verdict)
}

/// Judges a radar's clock by the LiDARs.
pub(super) fn of_radar(case: &mut Case, radar: usize) -> Option<Verdict> {
    let tally = |looks: &[&LidarLook], change: &SensorChange| {
        let setup = Setup { lidars: looks, ..case.setup() };
        let change = case.radar_changes[radar].and(change);
        overlap(&setup, radar, &case.sample.radars[radar], &change, Measure::Beside)
    };
    let mut looks = case.lidars.clone();
    looks.sort_by_key(|look| look.t_ns);
    let found = changed(&looks, tally)?;
    let what = if case.radars().count() > 1 { ITS_OWN } else { OR_LIDARS };
    let verdict = doubt(case.name(radar), found, what);
    case.leave_out(radar);
    Some(verdict)
}

/// Offsets at the begin and at the end, ms, that explain more than any other one change does: the same place that is
/// off, or the same yaw, looks like one clock when the vehicle is slow, and like another when it is fast.
fn changed<T>(looks: &[T], tally: impl Fn(&[T], &SensorChange) -> Tally) -> Option<[f64; 2]> {
    let found = clocks_of_parts(looks, &tally)?;
    let of_parts = |changes: [&SensorChange; 2]| {
        let tallies = parts(looks).into_iter().zip(changes).map(|(looks, change)| tally(looks, change));
        tallies.fold(Tally::default(), Tally::joined)
    };
    let [first, last] = found.map(SensorChange::clock);
    let apart = of_parts([&first, &last]);
    let mut others = shifts().chain(yaws()).chain(clocks()).chain([SensorChange::mirror()]);
    others.all(|other| of_parts([&other, &other]).is_beaten_by(&apart)).then_some(found)
}

/// The first and the last scans.
fn parts<T>(looks: &[T]) -> [&[T]; 2] {
    let count = (looks.len() as f64 * PART) as usize;
    [&looks[..count], &looks[looks.len() - count..]]
}

/// Offsets at the begin and at the end, ms, where they differ, each part denies the other's, and time is told in both.
fn clocks_of_parts<T>(looks: &[T], tally: impl Fn(&[T], &SensorChange) -> Tally) -> Option<[f64; 2]> {
    let parts = parts(looks);
    let at = |part: usize, ms: f64| tally(parts[part], &SensorChange::clock(ms));
    let best = |part: usize| {
        let tried = [0.0].into_iter().chain(clocks().map(|clock| clock.clock_ms));
        let tried = tried.map(|ms| (ms, at(part, ms)));
        let (ms, then) = tried.max_by(|a, b| a.1.share().total_cmp(&b.1.share()))?;
        // Along rails and walls any time fits.
        let is_peak = [-FOOT_MS, FOOT_MS].iter().all(|foot| at(part, ms + foot).is_beaten_by(&then));
        is_peak.then_some((ms, then))
    };
    let (first, last) = (best(0)?, best(1)?);
    let denies =
        |part: usize, own: &Tally, other: f64| at(part, other).is_beaten_by_factor(own, GAIN_OF_SHIFT);
    let differ = (first.0 - last.0).abs() >= OTHER_MS;
    let is_told = differ && denies(0, &first.1, last.0) && denies(1, &last.1, first.0);
    is_told.then_some([first.0, last.0])
}

/// Whether clocks change to the same side.
fn is_alike(a: [f64; 2], b: [f64; 2]) -> bool {
    (a[1] - a[0]).signum() == (b[1] - b[0]).signum()
}

fn doubt(name: &str, [first, last]: [f64; 2], what: &'static str) -> Verdict {
    let evidence = format!(
        "radar and LiDAR fit best with its times moved by {first:+.0} ms in the first part, and by {last:+.0} ms in \
         the last"
    );
    Verdict::doubt(name, Question::Clock, evidence, Some(Remedy::LookInto(what)))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is said of scans at these speeds, m/s, whose detections lie so far ahead of where they should, m.
    fn said(scans: &[(f64, f64)]) -> Option<[f64; 2]> {
        let moment = |&(speed, ahead): &(f64, f64), change: &SensorChange| {
            let off = ahead + change.shift_m[0] + speed * change.clock_ms * 1e-3;
            let turned = change.turn_deg[2] != 0.0 || change.mirrored || change.shift_m[1] != 0.0;
            let share = if turned { 0.1 } else { 0.1 + 0.5 / (1.0 + off * off * 8.0) };
            [share * 200.0, 200.0]
        };
        changed(scans, |scans, change| Tally {
            moments: scans.iter().map(|scan| moment(scan, change)).collect(),
        })
    }

    #[test]
    fn scans_that_were_lost_make_another_clock_and_a_place_that_is_off_makes_none() {
        let lost: Vec<_> = (0..30).map(|i| (8.0, if i < 15 { 0.0 } else { -2.4 })).collect();
        assert_eq!(said(&lost), Some([0.0, 300.0]));
        assert_eq!(said(&[(8.0, 0.0); 30]), None);
        // Half a metre is 250 ms at 2 m/s, and 40 ms at 12.
        let misplaced: Vec<_> = (0..30).map(|i| (if i < 15 { 2.0 } else { 12.0 }, -0.5)).collect();
        assert_eq!(said(&misplaced), None);
        let reversing: Vec<_> = (0..30).map(|i| (if i < 15 { -2.0 } else { 2.0 }, -0.5)).collect();
        assert_eq!(said(&reversing), None);
    }
}
