//! Where the radars' scans around could have seen a detection again, and whether they did.

use super::chance::SAME;
use super::cloud::{Cloud, Variances};
use super::distance::{Spot, chi_within};
use super::going::{Going, Goings};
use super::rates::{AGREEING, Rates};
use crate::scene::{Detection, Frame, NeighbouringDetections, NeighbouringScan, Reach, Sight, Sights};
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

/// One detection in one scan around that could have seen it if it stood still.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sighting {
    /// Which scan of the frame's `radar_window`.
    pub(super) scan: u32,
    /// Whether the same radar made it.
    pub(super) own: bool,
    /// Distance `chi` from the nearest detection there, in standard deviations; infinite where none is nearer than
    /// [`FARTHEST`].
    pub(super) still: f64,
}

/// One detection with its range rate in one of the same radar's scans around that could have seen it where it would be,
/// be it that it stands still or that it moves.
#[derive(Debug, Clone, Copy)]
pub(super) struct Meeting {
    /// Distance `chi` from the nearest detection there whose range rate agrees, in standard deviations; infinite where
    /// none is nearer than [`FARTHEST`].
    pub(super) chi: f64,
    /// The least difference of range rates from those of the detections there, in standard deviations; infinite where
    /// nothing is nearer than [`FARTHEST`].
    pub(super) rate_difference: f64,
}

/// What the scans around saw of one detection.
#[derive(Debug, Clone, Default)]
pub(super) struct Recurrence {
    /// In the order of the scans.
    pub(super) seen: Vec<Sighting>,
    /// In the order of the scans; of a detection that moves as it would move by what fits best. None without a range
    /// rate.
    pub(super) met: Vec<Meeting>,
}

/// What was seen again of each detection of a frame; nothing of a detection without a place. `rates` are those of the
/// frame's scan, `rows` its detections that have a place.
pub(super) fn recurrences<'a>(
    frame: &Frame,
    around: &NeighbouringDetections,
    rates: Option<&Rates>,
    rows: impl Iterator<Item = (usize, &'a Detection)>,
) -> Vec<Recurrence> {
    let reaches = reaches(frame);
    let radars = &frame.rig.radars;
    let scans = || frame.radar_window.iter().map(|scan| (&radars[scan.radar], scan, &reaches[scan.radar]));
    let sights = Sights::new(scans());
    let spots: Vec<Spot> = around.detections.iter().map(Spot::new).collect();
    let own = own_scans(frame, around, scans());
    let mut search = Search::new(frame, around, &spots, own, rates);
    let mut all = vec![Recurrence::default(); frame.scan.len()];
    for (i, detection) in rows {
        let mut seen: Vec<Sighting> = Vec::with_capacity(frame.radar_window.len());
        let mut scan = 0;
        sights.each(&detection.position, |covered| {
            search.places[scan] = if covered { seen.len() as u32 } else { UNSEEN };
            if covered {
                let own = around.own[scan];
                seen.push(Sighting { scan: scan as u32, own, still: f64::INFINITY });
            }
            scan += 1;
        });
        let still = search.still(i, &Spot::new(detection), &mut seen);
        let met = search.moving(i, detection).unwrap_or(still);
        all[i] = Recurrence { seen, met };
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

/// The radar's own scans around, each with what tells whether a place was in sight.
fn own_scans<'a>(
    frame: &Frame,
    around: &NeighbouringDetections,
    scans: impl Iterator<Item = (&'a Radar, &'a NeighbouringScan, &'a Reach)>,
) -> Vec<OwnScan<'a>> {
    let mut own = Vec::new();
    for (scan, (radar, neighbour, reach)) in scans.enumerate().filter(|(scan, _)| around.own[*scan]) {
        let mounting = neighbour.vehicle_from_scan * frame.radar.vehicle_from_radar;
        let origin = Point::from(mounting.translation.vector);
        let sight = Sight::new(radar, neighbour, reach);
        own.push(OwnScan { scan, seconds: around.seconds[scan], origin, sight });
    }
    own
}

/// One of the radar's own scans around.
struct OwnScan<'a> {
    /// Which of the frame's `radar_window`.
    scan: usize,
    /// After the frame's scan, s.
    seconds: f64,
    /// Where the radar was, m.
    origin: Point,
    sight: Sight<'a>,
}

impl Meeting {
    const NOBODY: Self = Self { chi: f64::INFINITY, rate_difference: f64::INFINITY };

    /// A detection at a distance `chi` from where this one would be; `difference` is that of their rates, in standard
    /// deviations.
    fn meet(&mut self, chi: f64, difference: Option<f64>) {
        let Some(difference) = difference else { return };
        self.rate_difference = self.rate_difference.min(difference);
        if difference <= AGREEING {
            self.chi = self.chi.min(chi);
        }
    }
}

/// How well a way to go fits what was met: the share of scans that saw it again, as if it had been seen in half of one
/// more; of equal ones the nearest.
fn fit(met: &[Meeting]) -> [f64; 2] {
    let again = met.iter().filter(|meeting| meeting.chi <= SAME).count() as f64;
    let distance: f64 = met.iter().map(|meeting| meeting.chi.min(FARTHEST)).sum();
    let scans = met.len() as f64;
    [(again + 0.5) / (scans + 1.0), -distance / scans.max(1.0)]
}

/// The search for a frame's detections among those around.
struct Search<'a> {
    rates: Option<&'a Rates>,
    goings: Option<Goings<'a>>,
    own: Vec<OwnScan<'a>>,
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
    /// The same of its meetings where it would be if it moved.
    met_places: Vec<u32>,
}

impl<'a> Search<'a> {
    /// `spots` are those of the detections around.
    fn new(
        frame: &Frame,
        around: &'a NeighbouringDetections,
        spots: &'a [Spot],
        own: Vec<OwnScan<'a>>,
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
            goings: rates.map(|rates| Goings::new(frame, rates)),
            own,
            around,
            spots,
            cloud,
            level: level.collect(),
            times,
            span: [earliest, latest],
            places: vec![UNSEEN; around.radars.len()],
            met_places: vec![UNSEEN; around.radars.len()],
        }
    }

    /// As if it stood still; what it met is that of one that does.
    fn still(&self, i: usize, spot: &Spot, seen: &mut [Sighting]) -> Vec<Meeting> {
        let standing = self.rates.filter(|rates| rates.residual(i).is_some() && rates.motion(i) == 0.0);
        let mut met = vec![Meeting::NOBODY; if standing.is_some() { seen.len() } else { 0 }];
        self.cloud.each_near(spot, FARTHEST, REACH, |id| {
            let scan = self.around.scans[id] as usize;
            let place = self.places[scan] as usize;
            let Some(sighting) = seen.get_mut(place) else { return };
            let standing = standing.filter(|_| sighting.own);
            // All count whose rate is asked, of the others only what is nearer than what is known.
            let limit = if standing.is_some() { FARTHEST } else { sighting.still.min(FARTHEST) };
            let Some(chi) = chi_within(limit, spot, &self.spots[id], self.level[scan]) else { return };
            sighting.still = sighting.still.min(chi);
            if let Some(rates) = standing {
                met[place].meet(chi, rates.difference(i, self.around.doppler[id]));
            }
        });
        let mut own = seen.iter().map(|sighting| sighting.own);
        met.retain(|_| own.next().unwrap_or_default());
        met
    }

    /// As if it moved, of one that does: whichever way to go fits best.
    fn moving(&mut self, i: usize, detection: &Detection) -> Option<Vec<Meeting>> {
        let ways: Vec<Going> = self.goings.as_ref()?.of(i, detection, 0.0).collect();
        let mut best: Option<([f64; 2], Vec<Meeting>)> = None;
        for going in ways {
            let met = self.met(detection, &going);
            let fit = fit(&met);
            if best.as_ref().is_none_or(|(known, _)| fit > *known) {
                best = Some((fit, met));
            }
        }
        best.map(|(_, met)| met)
    }

    /// What it met if it went this way.
    fn met(&mut self, detection: &Detection, going: &Going) -> Vec<Meeting> {
        let mut there: Vec<(&OwnScan, Spot)> = Vec::with_capacity(self.own.len());
        self.met_places.fill(UNSEEN);
        for own in &self.own {
            let moved = going.after(own.seconds);
            if own.sight.covers(&moved.position) {
                self.met_places[own.scan] = there.len() as u32;
                there.push((own, Spot::new(&moved)));
            }
        }
        let mut met = vec![Meeting::NOBODY; there.len()];
        let longest = self.span[1].max(-self.span[0]);
        let sought = Spot::new(&Detection { axes: going.after(longest).axes, ..*detection });
        self.cloud.each_met(&sought, going.velocity(), (&self.times, self.span), (FARTHEST, REACH), |id| {
            let scan = self.around.scans[id] as usize;
            let place = self.met_places[scan] as usize;
            let Some((own, spot)) = there.get(place) else { return };
            let other = &self.around.detections[id].position;
            if !is_in_reach(spot, &self.spots[id]) {
                return;
            }
            if let Some(chi) = chi_within(FARTHEST, spot, &self.spots[id], self.level[scan]) {
                met[place].meet(chi, going.rate_difference(other, &own.origin, self.around.doppler[id]));
            }
        });
        met
    }
}

/// Whether two spots lie no farther apart than [`REACH`], seen from above, as the search of those that stand sees them.
fn is_in_reach(a: &Spot, b: &Spot) -> bool {
    let [dx, dy] = [0, 1].map(|axis| b.place[axis] as f32 - a.place[axis] as f32);
    dx * dx + dy * dy <= REACH * REACH
}
