//! Where the radars' scans around could have seen a detection again, and whether they did.

use super::chance::SAME;
use super::distance::{Spot, chi_within};
use super::joint::Joint;
use super::meeting::{FARTHEST, Meeting, REACH};
use super::pursuit::{Other, Others, Pursuit};
use super::rates::Rates;
use crate::scene::{Detection, Frame, NeighbouringDetections, NeighbouringScan, Reach, Sight, Sights};
use crate::sensors::{Elevation, Radar};
use crate::space::Vector;
use std::rc::Rc;

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

/// What the scans around saw of one detection.
#[derive(Debug, Clone, Default)]
pub(super) struct Recurrence {
    /// In the order of the scans.
    pub(super) seen: Vec<Sighting>,
    /// In the order of the scans; of a detection that moves as it would move by what fits best. None without a range
    /// rate.
    pub(super) met: Vec<Meeting>,
    /// Where what stands still lies by all of the own scans that met it; of what moves, or has no range rate, where it
    /// was measured. `None` without a place.
    pub(super) joint: Option<Joint>,
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
    let sight =
        |scan: &NeighbouringScan| Sight::new(&frame.rig.radars[scan.radar], scan, &reaches[scan.radar]);
    let timed: Vec<(Sight, f64)> =
        frame.radar_window.iter().map(sight).zip(around.seconds.iter().copied()).collect();
    let own = timed.iter().zip(&around.own).filter(|(_, own)| **own);
    let own = Sights::new(own.map(|(timed, _)| timed.clone()));
    let sights = Sights::new(timed.into_iter());
    let others = Rc::new(Others::all(around));
    let mut search = Search::new(frame, around, &others, rates);
    let mut pursuit = rates.map(|rates| Pursuit::new(frame, around, &others, rates, own));
    let mut all = vec![Recurrence::default(); frame.scan.len()];
    for (i, detection) in rows {
        let mut seen: Vec<Sighting> = Vec::with_capacity(frame.radar_window.len());
        sights.each(&detection.position, &Vector::zeros(), |scan, covered| {
            search.places[scan] = if covered { seen.len() as u32 } else { UNSEEN };
            if covered {
                let own = around.own[scan];
                seen.push(Sighting { scan: scan as u32, own, still: f64::INFINITY });
            }
        });
        let still = search.still(i, &Spot::new(detection), &mut seen);
        let moving = pursuit.as_mut().and_then(|pursuit| pursuit.met(i, detection));
        let joint = match moving {
            Some(_) => Joint::alone(detection),
            None => search.joint(detection, &still),
        };
        all[i] = Recurrence { seen, met: moving.unwrap_or(still), joint: Some(joint) };
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

/// The search for a frame's detections among those around.
struct Search<'a> {
    rates: Option<&'a Rates>,
    others: &'a Others<'a>,
    /// Of each scan around: whether distances from its detections are horizontal, for either radar measures no
    /// elevation.
    level: Vec<bool>,
    /// The same of the radar's own scans.
    own_level: bool,
    /// Of each scan around, for the detection at hand: which of its sightings is that in this scan, or [`UNSEEN`].
    places: Vec<u32>,
}

impl<'a> Search<'a> {
    fn new(
        frame: &Frame,
        around: &NeighbouringDetections,
        others: &'a Others<'a>,
        rates: Option<&'a Rates>,
    ) -> Self {
        let is_level = |radar: &Radar| radar.elevation == Elevation::None;
        let level =
            around.radars.iter().map(|radar| is_level(frame.radar) || is_level(&frame.rig.radars[*radar]));
        let (level, own_level) = (level.collect(), is_level(frame.radar));
        Self { rates, others, level, own_level, places: vec![UNSEEN; around.radars.len()] }
    }

    /// As if it stood still; what it met is that of one that does.
    fn still(&self, i: usize, spot: &Spot, seen: &mut [Sighting]) -> Vec<Meeting> {
        let standing = self.rates.filter(|rates| rates.residual(i).is_some() && rates.motion(i) == 0.0);
        let mut met = vec![Meeting::NOBODY; if standing.is_some() { seen.len() } else { 0 }];
        self.others.cloud.each_near(spot, FARTHEST, REACH, |at, other| {
            let Other { scan, rate } = self.others.known[at];
            let (scan, place) = (scan as usize, self.places[scan as usize] as usize);
            let Some(sighting) = seen.get_mut(place) else { return };
            let standing = standing.filter(|_| sighting.own);
            // All count whose rate is asked, of the others only what is nearer than what is known.
            let limit = if standing.is_some() { FARTHEST } else { sighting.still.min(FARTHEST) };
            let Some(chi) = chi_within(limit, spot, other, self.level[scan]) else { return };
            sighting.still = sighting.still.min(chi);
            if let Some(rates) = standing {
                met[place].meet(at, chi, rates.difference(i, rate));
            }
        });
        let mut own = seen.iter().map(|sighting| sighting.own);
        met.retain(|_| own.next().unwrap_or_default());
        met
    }

    /// A detection with all that it met at its place.
    fn joint(&self, detection: &Detection, met: &[Meeting]) -> Joint {
        let again = met.iter().filter(|meeting| meeting.chi <= SAME);
        let again: Vec<&Spot> =
            again.map(|meeting| self.others.cloud.spot(meeting.nearest as usize)).collect();
        Joint::new(detection, &again, self.own_level)
    }
}
