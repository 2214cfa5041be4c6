//! A radar whose correction is sought, in the drives that can tell.

use super::super::case::Case;
use super::Refinement;
use super::behind::{Behind, Way};
use super::common::{common, is_alike_besides};
use super::evidence::Evidence;
use super::proposal::{proposed, told};
use super::search::{Open, Place, deviations, likeliest, summit};
use crate::change::SensorChange;
use crate::doppler::clock;
use crate::overlap::Measure;
use ralf::space::Transform;

/// A sensor that is written down so near another drive's is mounted as there, m and rad.
const SAME_PLACE: f64 = 0.005;
const SAME_DIRECTION: f64 = 0.002;

/// A radar, and what was found of it.
pub(super) struct Radar<'a> {
    /// The correction as the drives were judged one by one.
    alone: Refinement,
    /// Where the LiDARs see what the radar sees, and something can be judged.
    found: Option<Found<'a>>,
}

/// What a radar's correction is found from.
struct Found<'a> {
    drives: Vec<(&'a Case<'a>, usize)>,
    open: Open,
    way: Way,
}

impl<'a> Radar<'a> {
    /// From the drives in which it is mounted as in most.
    pub(super) fn of(cases: &'a [Case<'a>], name: &str) -> Self {
        let radar_of = |case: &Case| case.radars().find(|radar| case.name(*radar) == name);
        let all: Vec<(&Case, usize)> =
            cases.iter().filter_map(|case| Some((case, radar_of(case)?))).collect();
        let alike = mounted_alike(&all);
        let only_of = (alike.len() < all.len())
            .then(|| alike.iter().map(|(case, _)| case.sequence.name.clone()).collect());
        let (base, found) = of_drives(&alike);
        Self { alone: Refinement { only_of, ..Refinement::as_found(name, base) }, found }
    }

    /// Its corrections by how far behind things it hears them, where the LiDARs tell its place: of one that range rates
    /// alone can judge, few detections lie on what LiDARs see, and by chance.
    pub(super) fn way(&self) -> Option<&Way> {
        let told = |found: &&Found| found.open[1] || found.open[2];
        self.found.as_ref().filter(told).map(|found| &found.way)
    }

    pub(super) fn refined(self, behind: Behind) -> Refinement {
        let Some(Found { drives, open, way }) = self.found else { return self.alone };
        let evidence = Evidence::of(&drives, self.alone.change, behind.metres);
        let place = summit(&evidence, Place::at(&evidence, way.at(behind.metres)), open);
        let (open, place) = told_along(&evidence, place, open);
        let deviations = deviations(&evidence, &place, open, &way.by_deviation(behind));
        Refinement {
            change: evidence.change(&place.values),
            deviations: std::array::from_fn(|i| told(&deviations, i)),
            proposed: evidence.change(&proposed(&evidence, place, &deviations, open).values),
            ..self.alone
        }
    }
}

/// From drives of one mounting: those in which the LiDARs see what the radar sees, and something can be judged.
fn of_drives<'a>(drives: &[(&'a Case<'a>, usize)]) -> (SensorChange, Option<Found<'a>>) {
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
        return (base, None);
    }
    let mut evidence = Evidence::of(&telling, base, 0.0);
    let (open, place) = found(&evidence, std::array::from_fn(|i| opens.iter().any(|open| open[i])));
    let way = Way::of(&mut evidence, place, open);
    (base, Some(Found { drives: telling, open, way }))
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

/// The likeliest values of what is open.
fn found(evidence: &Evidence, open: Open) -> (Open, Place) {
    told_along(evidence, likeliest(evidence, &evidence.start(), open), open)
}

/// A LiDAR that doesn't tell how far along the way things are would pull at that and at the clock all the same: then
/// both are left alone.
fn told_along(evidence: &Evidence, place: Place, open: Open) -> (Open, Place) {
    let [yaw, forward, left, _] = open;
    if !forward || evidence.tells_along(&place.values) {
        return (open, place);
    }
    let open = [yaw, false, left, false];
    (open, likeliest(evidence, &evidence.start(), open))
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
