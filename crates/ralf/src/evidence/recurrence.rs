//! Where the radars' scans around could have seen a detection again, and whether they did.

use super::cloud::{Cloud, Variances};
use super::distance::{Spot, chi_within};
use super::rates::{AGREEING, Rates};
use crate::scene::{Detection, Frame, NeighbouringDetections, Reach, Sights};
use crate::sensors::{Elevation, Radar};
use crate::space::Point;
use std::borrow::Cow;
use std::rc::Rc;

/// Nothing farther is looked for, in standard deviations.
pub(super) const FARTHEST: f64 = 3.0;
/// Nor anything farther than this, m, whatever the radar's uncertainty is said to be.
const REACH: f32 = 8.0;
/// Of a scan that can't have seen a detection there is no sighting.
const UNSEEN: u32 = u32::MAX;

/// One detection in one scan around that could have seen it. Distances are those to the nearest detection there,
/// infinite where none is nearer than [`FARTHEST`].
#[derive(Debug, Clone, Copy)]
pub(super) struct Sighting {
    /// Which scan of the frame's `radar_window`.
    pub(super) scan: u32,
    /// Whether the same radar made it.
    pub(super) own: bool,
    /// Distance `chi` from where the detection would be if it stood still, in standard deviations.
    pub(super) still: f64,
    /// Distance `chi` from where the detection would be if it moved along its ray at its range rate, to those whose
    /// range rate agrees; of the same radar's scans alone.
    pub(super) moving: f64,
    /// The least difference of range rates from those that lie where it would be, in spreads; of the same radar's
    /// scans alone.
    pub(super) rate_difference: f64,
}

/// The sightings of each detection of a frame, in the order of the scans around; none of a detection without a place.
/// `rates` are those of the frame's scan, `rows` its detections that have a place.
pub(super) fn sightings<'a>(
    frame: &Frame,
    around: &NeighbouringDetections,
    rates: Option<&Rates>,
    rows: impl Iterator<Item = (usize, &'a Detection)>,
) -> Vec<Vec<Sighting>> {
    let reaches = reaches(frame);
    let radars = &frame.rig.radars;
    let scans = frame.radar_window.iter();
    let sights = Sights::new(scans.map(|scan| (&radars[scan.radar], scan, &reaches[scan.radar])));
    let spots: Vec<Spot> = around.detections.iter().map(Spot::new).collect();
    let mut search = Search::new(frame, around, &spots, rates);
    let mut all = vec![Vec::new(); frame.scan.len()];
    for (i, detection) in rows {
        let mut seen: Vec<Sighting> = Vec::with_capacity(frame.radar_window.len());
        let mut scan = 0;
        sights.each(&detection.position, |covered| {
            search.places[scan] = if covered { seen.len() as u32 } else { UNSEEN };
            if covered {
                seen.push(Sighting::nothing(scan as u32, around.own[scan]));
            }
            scan += 1;
        });
        search.compare(i, detection, &mut seen);
        all[i] = seen;
    }
    all
}

/// How far each radar of the rig reaches, by its scans at hand.
fn reaches(frame: &Frame) -> Vec<Reach> {
    let mut reaches = Vec::with_capacity(frame.rig.radars.len());
    for (index, radar) in frame.rig.radars.iter().enumerate() {
        let around = frame.radar_window.iter().filter(|scan| scan.radar == index).map(|scan| &*scan.scan);
        let own = frame.is_own(index).then_some(&*frame.scan);
        reaches.push(Reach::of_scans(radar, around.chain(own)));
    }
    reaches
}

impl Sighting {
    fn nothing(scan: u32, own: bool) -> Self {
        let none = f64::INFINITY;
        Self { scan, own, still: none, moving: none, rate_difference: none }
    }

    /// A detection at a distance `chi` from where this one would be if it moved; `difference` is that of their rates,
    /// in spreads.
    fn meet(&mut self, chi: f64, difference: Option<f64>) {
        let Some(difference) = difference else { return };
        self.rate_difference = self.rate_difference.min(difference);
        if difference <= AGREEING {
            self.moving = self.moving.min(chi);
        }
    }
}

/// The search for a frame's detections among those around.
struct Search<'a> {
    rates: Option<&'a Rates>,
    /// The frame's radar, m.
    origin: Point,
    around: &'a NeighbouringDetections,
    /// Of the detections around.
    spots: &'a [Spot],
    cloud: Cloud<'a>,
    /// Of each scan around: whether distances from its detections are horizontal, for either radar measures no
    /// elevation.
    level: Vec<bool>,
    /// When each detection around was made, s after the frame's scan, in the order of the cloud's index; not a number
    /// of other radars' detections. None at all where no range rates tell what moves.
    times: Vec<f32>,
    /// The first and the last of them.
    span: [f64; 2],
    /// Of each scan around, for the detection at hand: which of its sightings is that in this scan, or [`UNSEEN`].
    places: Vec<u32>,
}

impl<'a> Search<'a> {
    /// `spots` are those of the detections around.
    fn new(
        frame: &Frame,
        around: &'a NeighbouringDetections,
        spots: &'a [Spot],
        rates: Option<&'a Rates>,
    ) -> Self {
        let is_level = |radar: &Radar| radar.elevation == Elevation::None;
        let level =
            around.radars.iter().map(|radar| is_level(frame.radar) || is_level(&frame.rig.radars[*radar]));
        let cloud = Cloud::new(Cow::Borrowed(&around.index), spots, Rc::new(Variances::new(spots)));
        let time = |id: usize| {
            let scan = around.scans[id] as usize;
            if around.own[scan] { around.seconds[scan] as f32 } else { f32::NAN }
        };
        let times = if rates.is_some() { cloud.in_order(time) } else { Vec::new() };
        let earliest = around.seconds.iter().copied().fold(0.0, f64::min);
        let latest = around.seconds.iter().copied().fold(0.0, f64::max);
        Self {
            rates,
            origin: Point::from(frame.radar.vehicle_from_radar.translation.vector),
            around,
            spots,
            cloud,
            level: level.collect(),
            times,
            span: [earliest, latest],
            places: vec![UNSEEN; around.radars.len()],
        }
    }

    /// Compares a detection with those that lie where it would be.
    fn compare(&self, i: usize, detection: &Detection, seen: &mut [Sighting]) {
        let spot = Spot::new(detection);
        self.still(i, &spot, seen);
        self.moving(i, &spot, seen);
    }

    /// As if it stood still.
    fn still(&self, i: usize, spot: &Spot, seen: &mut [Sighting]) {
        let standing = self.rates.filter(|rates| rates.motion(i) == 0.0);
        self.cloud.each_near(spot, FARTHEST, REACH, |id| {
            let scan = self.around.scans[id] as usize;
            let Some(sighting) = seen.get_mut(self.places[scan] as usize) else { return };
            let standing = standing.filter(|_| sighting.own);
            // All count whose rate is asked, of the others only what is nearer than what is known.
            let limit = if standing.is_some() { FARTHEST } else { sighting.still.min(FARTHEST) };
            let Some(chi) = chi_within(limit, spot, &self.spots[id], self.level[scan]) else { return };
            sighting.still = sighting.still.min(chi);
            if let Some(rates) = standing {
                sighting.meet(chi, rates.difference(i, self.around.doppler[id]));
            }
        });
    }

    /// Where it would be if it moved, of one that moves.
    fn moving(&self, i: usize, spot: &Spot, seen: &mut [Sighting]) {
        let Some(rates) = self.rates.filter(|rates| rates.motion(i) != 0.0) else { return };
        let ray = (spot.place - self.origin.coords).try_normalize(0.0).unwrap_or_default();
        let rate = rates.motion(i);
        let velocity = [rate * ray.x, rate * ray.y];
        self.cloud.each_met(spot, velocity, (&self.times, self.span), (FARTHEST, REACH), |id| {
            let scan = self.around.scans[id] as usize;
            let Some(sighting) = seen.get_mut(self.places[scan] as usize) else { return };
            let there = spot.moved(&(ray * (rate * self.around.seconds[scan])));
            if !is_in_reach(&there, &self.spots[id]) {
                return;
            }
            if let Some(chi) = chi_within(FARTHEST, &there, &self.spots[id], self.level[scan]) {
                sighting.meet(chi, rates.difference(i, self.around.doppler[id]));
            }
        });
    }
}

/// Whether two spots lie no farther apart than [`REACH`], seen from above, as the search of those that stand sees them.
fn is_in_reach(a: &Spot, b: &Spot) -> bool {
    let [dx, dy] = [0, 1].map(|axis| b.place[axis] as f32 - a.place[axis] as f32);
    dx * dx + dy * dy <= REACH * REACH
}
