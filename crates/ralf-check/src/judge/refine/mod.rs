//! Corrections made exact: yaw, place in plan and clock of each radar, jointly from range rates and the LiDAR, and from
//! all drives of a vehicle, with standard deviations.
//!
//! What is maximised is a log-likelihood: detections lie beside LiDAR points, velocities are those of the vehicle,
//! and small corrections are likelier than large ones.

mod beside;
mod evidence;
mod fronts;
mod quantity;
mod search;

use super::case::Case;
use crate::change::SensorChange;
use crate::doppler::clock;
use crate::overlap::Measure;
use evidence::Evidence;
use quantity::{QUANTITIES, Quantity, Values, values};
use ralf::space::Transform;
use search::{Deviations, Open, deviations, likeliest};
use serde::Serialize;

/// A correction is proposed when it is so many of the standard deviations that chance gives.
const SIGMAS: f64 = 3.0;
/// And so many of those that are told: what one recording in twenty shows that is right is no reason to change it.
const TOLD_SIGMAS: f64 = 2.0;
/// Changes of several drives that differ by less than this are one, in what one expects to be off.
const ALIKE: f64 = 0.4;
/// A sensor that is written down so near another drive's is mounted as there, m and rad.
const SAME_PLACE: f64 = 0.005;
const SAME_DIRECTION: f64 = 0.002;

/// The correction of one sensor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Refinement {
    /// The sensor's name.
    pub name: String,
    /// What is likeliest to be added.
    pub change: SensorChange,
    /// Standard deviations of yaw (degrees), of the place forward and to the left (m) and of the clock (ms), each with
    /// the others unknown, and with what more measurements would not take away. NaN of a sensor whose change was found
    /// and not refined.
    pub deviations: [f64; 4],
    /// What is proposed: quantities that are three standard deviations of chance, two of [`Self::deviations`], and more
    /// than labels notice, and the likeliest of these with all others left alone.
    pub proposed: SensorChange,
    /// The sequences that it is of, by name, where not all have the sensor mounted alike.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub only_of: Option<Vec<String>>,
}

/// The corrections of all LiDARs, as they were found in more drives than not, and with these in place of all radars.
pub(super) fn refine(cases: &mut [Case]) -> Vec<Refinement> {
    let mut refined = Vec::new();
    for name in names(cases, |case| case.sequence.rig.lidars.iter().map(|lidar| &lidar.name).collect()) {
        let number = |case: &Case| case.sequence.rig.lidars.iter().position(|lidar| lidar.name == name);
        let judged = cases.iter().filter(|case| is_seen(case));
        let found = judged.filter_map(|case| Some(case.lidar_changes[number(case)?]));
        let change = common(&found.collect::<Vec<_>>());
        for case in &mut *cases {
            number(case).into_iter().for_each(|lidar| case.lidar_changes[lidar] = change);
        }
        refined.push(as_found(&name, change));
    }
    let radars =
        names(cases, |case| case.radars().map(|radar| &case.sequence.rig.radars[radar].name).collect());
    refined.extend(radars.iter().map(|name| of_radar(cases, name)));
    refined
}

/// Whether LiDARs and radars see so much together that LiDARs can be judged.
fn is_seen(case: &Case) -> bool {
    let mut seen = case.radars().map(|radar| case.overlap(radar, &SensorChange::default(), Measure::Beside));
    seen.any(|tally| tally.is_enough())
}

/// Names of sensors, each once, in the order of the rigs.
fn names<'a>(cases: &'a [Case], of: impl Fn(&'a Case<'a>) -> Vec<&'a String>) -> Vec<String> {
    let mut names = Vec::new();
    for name in cases.iter().flat_map(of) {
        if !names.contains(name) {
            names.push(name.clone());
        }
    }
    names
}

/// What was found in most drives; nothing where most found nothing, or something else each.
fn common(changes: &[SensorChange]) -> SensorChange {
    let is_like = |a: &SensorChange, b: &SensorChange| {
        (values(a) - values(b)).amax() <= ALIKE && is_alike_besides(a, b)
    };
    let count = |change: &SensorChange| changes.iter().filter(|other| is_like(change, other)).count();
    let most = changes.iter().copied().find(|change| 2 * count(change) > changes.len());
    most.unwrap_or_default()
}

/// Whether two changes are the same but for what is refined.
fn is_alike_besides(a: &SensorChange, b: &SensorChange) -> bool {
    let rest =
        |change: &SensorChange| (change.mirrored, change.turn_deg[0], change.turn_deg[1], change.shift_m[2]);
    rest(a) == rest(b)
}

/// A sensor's change as it was found.
fn as_found(name: &str, change: SensorChange) -> Refinement {
    Refinement { name: name.to_owned(), change, deviations: [f64::NAN; 4], proposed: change, only_of: None }
}

/// A radar's, from the drives in which it is mounted as in most.
fn of_radar(cases: &[Case], name: &str) -> Refinement {
    let radar_of = |case: &Case| case.radars().find(|radar| case.name(*radar) == name);
    let all: Vec<(&Case, usize)> = cases.iter().filter_map(|case| Some((case, radar_of(case)?))).collect();
    let alike = mounted_alike(&all);
    let only_of =
        (alike.len() < all.len()).then(|| alike.iter().map(|(case, _)| case.sequence.name.clone()).collect());
    Refinement { only_of, ..of_drives(&alike, name) }
}

/// From drives of one mounting: those in which the LiDARs see what the radar sees, and something can be judged.
fn of_drives(drives: &[(&Case, usize)], name: &str) -> Refinement {
    let change = |(case, radar): &(&Case, usize)| case.radar_changes[*radar];
    let judged = drives.iter().filter_map(|drive| Some((*drive, judgeable(drive)?)));
    let judged: Vec<_> = judged.filter(|(_, open)| open.contains(&true)).collect();
    let changes: Vec<SensorChange> = match judged.is_empty() {
        true => drives.iter().map(change).collect(),
        false => judged.iter().map(|(drive, _)| change(drive)).collect(),
    };
    let base = common(&changes);
    let telling = judged.into_iter().filter(|(drive, _)| is_alike_besides(&change(drive), &base));
    let (telling, opens): (Vec<_>, Vec<Open>) = telling.unzip();
    if telling.is_empty() {
        return as_found(name, base);
    }
    let evidence = Evidence::of(&telling, base);
    let (open, values) = found(&evidence, std::array::from_fn(|i| opens.iter().any(|open| open[i])));
    let deviations = deviations(&evidence, &values, open);
    Refinement {
        change: evidence.change(&values),
        deviations: std::array::from_fn(|i| told(&deviations, i)),
        proposed: evidence.change(&proposed(&evidence, values, &deviations, open)),
        ..as_found(name, base)
    }
}

/// The most drives in which a radar is mounted alike, of as many the first.
fn mounted_alike<'a>(all: &[(&'a Case<'a>, usize)]) -> Vec<(&'a Case<'a>, usize)> {
    let mount = |(case, radar): &(&Case, usize)| case.sequence.rig.radars[*radar].vehicle_from_radar;
    let like = |own: &(&'a Case<'a>, usize)| -> Vec<(&'a Case<'a>, usize)> {
        all.iter().copied().filter(|other| is_mounted_alike(&mount(own), &mount(other))).collect()
    };
    let groups = all.iter().map(like);
    groups.rev().max_by_key(Vec::len).unwrap_or_default()
}

/// Drives with one calibration: what is written down is rounded.
fn is_mounted_alike(a: &Transform, b: &Transform) -> bool {
    let apart = (a.translation.vector - b.translation.vector).norm();
    apart < SAME_PLACE && a.rotation.angle_to(&b.rotation) < SAME_DIRECTION
}

/// The likeliest values of what is open. A LiDAR that doesn't tell how far along the way things are would pull at that
/// and at the clock all the same: then both are left alone.
fn found(evidence: &Evidence, open: Open) -> (Open, Values) {
    let [yaw, forward, left, _] = open;
    let values = likeliest(evidence, &evidence.start(), open);
    if !forward || evidence.tells_along(&values) {
        return (open, values);
    }
    let open = [yaw, false, left, false];
    (open, likeliest(evidence, &evidence.start(), open))
}

/// How well a quantity is known in its unit, with what more measurements would not take away.
fn told(deviations: &Deviations, quantity: usize) -> f64 {
    let measured = deviations.chance[quantity].hypot(deviations.contradiction[quantity]).min(1.0);
    let Quantity { prior, systematic, .. } = QUANTITIES[quantity];
    (measured * prior).hypot(systematic)
}

/// Quantities that say nothing are left alone, the least telling one first; what goes together with them is sought
/// again without. What can't be judged here stays as it was found.
fn proposed(
    evidence: &Evidence,
    likeliest_of_all: Values,
    deviations: &Deviations,
    mut open: Open,
) -> Values {
    let mut values = likeliest_of_all;
    while let Some(least) = idle(&values, deviations, open).or_else(|| hardly_missed(evidence, &values, open))
    {
        values = without(evidence, &values, open, least);
        open[least] = false;
    }
    values
}

/// The least telling quantity of those that are smaller than what is proposed.
fn idle(values: &Values, deviations: &Deviations, open: Open) -> Option<usize> {
    let in_sigmas = |i: &usize| values[*i].abs() / deviations.chance[*i];
    let is_idle = |i: &usize| {
        let least = QUANTITIES[*i].smallest.max(TOLD_SIGMAS * told(deviations, *i));
        in_sigmas(i) < SIGMAS || values[*i].abs() * QUANTITIES[*i].prior < least
    };
    let idle = (0..4).filter(|i| open[*i]).filter(is_idle);
    idle.min_by(|a, b| in_sigmas(a).total_cmp(&in_sigmas(b)))
}

/// The quantity without which values are least less likely, if that is less than so many standard deviations mean:
/// farther from its maximum a likelihood may fall off less than about it.
fn hardly_missed(evidence: &Evidence, values: &Values, open: Open) -> Option<usize> {
    let highest = evidence.posterior(values);
    let gain = |i: usize| highest - evidence.posterior(&without(evidence, values, open, i));
    let gains = (0..4).filter(|i| open[*i]).map(|i| (i, gain(i)));
    let hardly = gains.filter(|(_, gain)| *gain < SIGMAS * SIGMAS / 2.0);
    hardly.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(i, _)| i)
}

/// The likeliest values without a quantity.
fn without(evidence: &Evidence, values: &Values, mut open: Open, quantity: usize) -> Values {
    let mut start = *values;
    (start[quantity], open[quantity]) = (0.0, false);
    likeliest(evidence, &start, open)
}

/// Which quantities can be judged in a drive: a yaw by range rates or the LiDAR, a place by the LiDAR alone, a clock by
/// the LiDAR or by speeds that change. `None` where the LiDARs don't see what the radar sees: whatever would lay one
/// onto the other is chance.
fn judgeable((case, radar): &(&Case, usize)) -> Option<Open> {
    let beside = case.overlap(*radar, &SensorChange::default(), Measure::Beside);
    let by_lidar = beside.is_enough();
    if by_lidar && !beside.is_above_chance(&case.elsewhere(*radar)) {
        return None;
    }
    let mount = case.mount(*radar);
    let figures = case.doppler(*radar, &case.motion, &mount);
    let timed = figures.and_then(|figures| clock(&case.fits[*radar], &case.motion, &mount, &figures));
    let by_speeds = timed.is_some_and(|clock| clock.is_sharp);
    Some([by_lidar || figures.is_some(), by_lidar, by_lidar, by_lidar || by_speeds])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_most_drives_ask_for_is_common_and_what_one_asks_for_is_not() {
        let nothing = SensorChange::default();
        let [near, nearer] = [SensorChange::yaw(-4.0), SensorChange::yaw(-4.6)];
        assert_eq!(common(&[nearer]), nearer, "of a single drive all");
        assert_eq!(common(&[near, nothing, nothing]), nothing);
        assert_eq!(common(&[near, nothing]), nothing, "as many deny it");
        assert_eq!(common(&[near, nearer, nothing]), near);
        let other = SensorChange::yaw(170.0);
        assert_eq!(common(&[near, other, nothing]), nothing, "each something else");
        assert_eq!(common(&[near, SensorChange { mirrored: true, ..near }, nothing]), nothing);
    }
}
