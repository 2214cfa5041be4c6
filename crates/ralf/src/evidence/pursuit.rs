//! Where the radar's own scans around would have seen again what moves, and what they saw there.

use super::cloud::{Cloud, Times};
use super::distance::{DriftingSpot, Spot, chi_within};
use super::going::{Going, Goings};
use super::meeting::{FARTHEST, Meeting, REACH, fit};
use super::rates::Rates;
use crate::scene::{Detection, Frame, NeighbouringDetections, Sights, index_of};
use crate::sensors::Elevation;
use crate::space::{NeighborIndex, Vector};
use std::borrow::Cow;
use std::rc::Rc;

/// Where nothing would have been seen.
const UNSEEN: u32 = u32::MAX;

/// The search for what moves.
pub(super) struct Pursuit<'a> {
    goings: Goings<'a>,
    own: Vec<OwnScan>,
    /// Those of the own scans.
    sights: Sights<'a>,
    others: Rc<Others<'a>>,
    /// When each of these was made, s after the frame's scan.
    times: Times,
    /// Whether distances are horizontal, for the radar measures no elevation.
    level: bool,
    /// Of each scan around, for the way at hand: which of `there`, or [`UNSEEN`].
    places: Vec<u32>,
    /// Of each of the own scans that could have seen the detection at hand where it would be.
    there: Vec<There>,
}

/// Where the detection at hand would be in one of the radar's own scans.
struct There {
    spot: Spot,
    /// Where the radar was, m.
    origin: Vector,
}

/// One of the radar's own scans around.
struct OwnScan {
    /// Which of the frame's `radar_window`.
    scan: usize,
    /// Where the radar was, m.
    origin: Vector,
}

/// Detections around, to be searched.
pub(super) struct Others<'a> {
    pub(super) cloud: Cloud<'a>,
    /// In the order of the cloud.
    pub(super) known: Vec<Other>,
}

/// What is asked of a detection around, besides where it is.
pub(super) struct Other {
    /// Its scan, of the frame's `radar_window`.
    pub(super) scan: u32,
    /// Compensated range rate, m/s; NaN where it was not measured.
    pub(super) rate: f64,
}

impl<'a> Others<'a> {
    /// All of them.
    pub(super) fn all(around: &'a NeighbouringDetections) -> Self {
        Self::new(around, Cow::Borrowed(&around.index), |place| place)
    }

    /// Those of the radar's own scans.
    fn own(around: &'a NeighbouringDetections) -> Self {
        let is_own = |id: &usize| around.own[around.scans[*id] as usize];
        let ids: Vec<usize> = (0..around.len()).filter(is_own).collect();
        let index = index_of(ids.iter().map(|id| &around.detections[*id].position), Elevation::None);
        Self::new(around, Cow::Owned(index), |place| ids[place])
    }

    fn new(
        around: &'a NeighbouringDetections,
        index: Cow<'a, NeighborIndex>,
        id: impl Fn(usize) -> usize,
    ) -> Self {
        let cloud = Cloud::new(index, |place| &around.detections[id(place)]);
        let known = |place| Other { scan: around.scans[id(place)], rate: around.doppler[id(place)] };
        Self { known: cloud.in_order(known).collect(), cloud }
    }
}

impl<'a> Pursuit<'a> {
    /// `all` are the detections around, `rates` those of the frame's scan, `sights` those of the radar's own scans
    /// around.
    pub(super) fn new(
        frame: &Frame,
        around: &'a NeighbouringDetections,
        all: &Rc<Others<'a>>,
        rates: &'a Rates,
        sights: Sights<'a>,
    ) -> Self {
        let is_alone = around.own.iter().all(|own| *own);
        let others = if is_alone { Rc::clone(all) } else { Rc::new(Others::own(around)) };
        let seconds = |other: &Other| around.seconds[other.scan as usize];
        let each = others.known.iter().map(|other| seconds(other) as f32);
        let earliest = around.seconds.iter().copied().fold(0.0, f64::min);
        let latest = around.seconds.iter().copied().fold(0.0, f64::max);
        Self {
            goings: Goings::new(frame, rates),
            own: own_scans(frame, around),
            sights,
            times: Times::new(each, [earliest, latest]),
            others,
            level: frame.radar.elevation == Elevation::None,
            places: vec![UNSEEN; around.radars.len()],
            there: Vec::new(),
        }
    }

    /// What a detection of the frame's scan met if it moves: whichever way to go fits best; `None` of one that doesn't.
    pub(super) fn met(&mut self, i: usize, detection: &Detection) -> Option<Vec<Meeting>> {
        let mut best: Option<([f64; 2], Vec<Meeting>)> = None;
        for going in self.goings.of(i, detection, 0.0).iter().flatten() {
            let met = self.met_on(going);
            let fit = fit(&met);
            if best.as_ref().is_none_or(|(known, _)| fit > *known) {
                best = Some((fit, met));
            }
        }
        best.map(|(_, met)| met)
    }

    /// What it met if it went this way.
    fn met_on(&mut self, going: &Going) -> Vec<Meeting> {
        let drifting = going.drift();
        self.go(&drifting);
        let mut met = vec![Meeting::NOBODY; self.there.len()];
        self.others.cloud.each_met(&drifting, &self.times, FARTHEST, REACH, |at, other| {
            let Other { scan, rate } = self.others.known[at];
            let place = self.places[scan as usize] as usize;
            let there = self.there.get(place).filter(|there| is_in_reach(&there.spot, other));
            let Some(There { spot, origin }) = there else { return };
            if let Some(chi) = chi_within(FARTHEST, spot, other, self.level) {
                met[place].meet(at, chi, going.rate_difference(&other.place, origin, rate));
            }
        });
        met
    }

    /// To where it would be in each of the own scans that could have seen it there.
    fn go(&mut self, drifting: &DriftingSpot) {
        let Self { own, sights, there, places, .. } = self;
        there.clear();
        sights.each(&drifting.spot.place.into(), &drifting.drift.place, |at, covered| {
            let Some(own) = own.get(at) else { return };
            places[own.scan] = if covered { there.len() as u32 } else { UNSEEN };
            if covered {
                there.push(There { spot: drifting.after(sights.seconds(at)), origin: own.origin });
            }
        });
    }
}

/// The radar's own scans around.
fn own_scans(frame: &Frame, around: &NeighbouringDetections) -> Vec<OwnScan> {
    let mut own = Vec::new();
    for (scan, neighbour) in frame.radar_window.iter().enumerate().filter(|(scan, _)| around.own[*scan]) {
        let mounting = neighbour.vehicle_from_scan * frame.radar.vehicle_from_radar;
        own.push(OwnScan { scan, origin: mounting.translation.vector });
    }
    own
}

/// Whether two spots lie no farther apart than [`REACH`], seen from above, as the search of those that stand sees them.
fn is_in_reach(a: &Spot, b: &Spot) -> bool {
    let [dx, dy] = [0, 1].map(|axis| b.place[axis] as f32 - a.place[axis] as f32);
    dx * dx + dy * dy <= REACH * REACH
}
