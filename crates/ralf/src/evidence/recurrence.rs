//! Where the radars' scans around could have seen a detection again, and whether they did.

use super::distance::{Spot, chi_within, farthest_within, largest_variance};
use super::rates::{AGREEING, Rates};
use crate::scene::{Detection, Frame, NeighbouringDetections, NeighbouringScan, Reach, Sight};
use crate::sensors::{Elevation, Radar};
use crate::space::{NeighborIndex, Point};
use std::borrow::Cow;

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
    let sight =
        |scan: &NeighbouringScan| Sight::new(&frame.rig.radars[scan.radar], scan, &reaches[scan.radar]);
    let sights: Vec<Sight> = frame.radar_window.iter().map(sight).collect();
    let mut search = Search::new(frame, around, rates);
    let mut all = vec![Vec::new(); frame.scan.len()];
    for (i, detection) in rows {
        let mut seen: Vec<Sighting> = Vec::with_capacity(sights.len());
        for (scan, sight) in (0u32..).zip(&sights) {
            let covered = sight.covers(&detection.position);
            search.places[scan as usize] = if covered { seen.len() as u32 } else { UNSEEN };
            if covered {
                seen.push(Sighting::nothing(scan, around.own[scan as usize]));
            }
        }
        search.compare(i, detection, &mut seen);
        all[i] = seen;
    }
    all
}

/// How far each radar of the rig reaches, by its scans at hand.
fn reaches(frame: &Frame) -> Vec<Reach> {
    let mut reaches = Vec::with_capacity(frame.rig.radars.len());
    for (index, radar) in frame.rig.radars.iter().enumerate() {
        let around =
            frame.radar_window.iter().filter(|scan| scan.radar == index).map(|scan| &scan.scan.measured);
        let own = frame.is_own(index).then_some(&frame.scan.measured);
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
    around: Cloud<'a>,
    /// Of each scan around: its own detections, if the same radar made it and range rates tell what moves.
    scans: Vec<Option<Cloud<'a>>>,
    /// Of each scan around: its time after the frame's, s.
    seconds: &'a [f64],
    /// No horizontal variance of the detections around is larger, m^2.
    max_variance: f64,
    /// Of each scan around, for the detection at hand: which of its sightings is that in this scan, or [`UNSEEN`].
    places: Vec<u32>,
}

impl<'a> Search<'a> {
    fn new(frame: &Frame, around: &'a NeighbouringDetections, rates: Option<&'a Rates>) -> Self {
        let is_level = |radar: &Radar| radar.elevation == Elevation::None;
        let level =
            around.radars.iter().map(|radar| is_level(frame.radar) || is_level(&frame.rig.radars[*radar]));
        let level: Vec<bool> = level.collect();
        let all = Cloud::new(Cow::Borrowed(&around.index), around, &level);
        Self {
            rates,
            origin: Point::from(frame.radar.vehicle_from_radar.translation.vector),
            max_variance: largest_variance(all.others.iter().map(|other| &other.spot)),
            around: all,
            scans: if rates.is_some() { own_scans(around, &level) } else { Vec::new() },
            seconds: &around.seconds,
            places: vec![UNSEEN; around.radars.len()],
        }
    }

    /// Compares a detection with those that lie where it would be.
    fn compare(&self, i: usize, detection: &Detection, seen: &mut [Sighting]) {
        let spot = Spot::new(detection);
        let reach = farthest_within(FARTHEST, &spot, self.max_variance).min(REACH);
        self.still(i, &detection.position, &spot, reach, seen);
        self.moving(i, &detection.position, &spot, reach, seen);
    }

    /// As if it stood still.
    fn still(&self, i: usize, p: &Point, spot: &Spot, reach: f32, seen: &mut [Sighting]) {
        let standing = self.rates.filter(|rates| rates.motion(i) == 0.0);
        self.around.each_near(p, spot, reach, |other, chi| {
            let Some(sighting) = seen.get_mut(self.places[other.scan as usize] as usize) else { return };
            sighting.still = sighting.still.min(chi);
            if let Some(rates) = standing.filter(|_| sighting.own) {
                sighting.meet(chi, rates.difference(i, other.rate));
            }
        });
    }

    /// Where it would be if it moved, of one that moves.
    fn moving(&self, i: usize, p: &Point, spot: &Spot, reach: f32, seen: &mut [Sighting]) {
        let Some(rates) = self.rates.filter(|rates| rates.motion(i) != 0.0) else { return };
        let ray = (p - self.origin).try_normalize(0.0).unwrap_or_default();
        for sighting in seen {
            let scan = sighting.scan as usize;
            let Some(cloud) = &self.scans[scan] else { continue };
            let way = ray * (rates.motion(i) * self.seconds[scan]);
            cloud.each_near(&(p + way), &spot.moved(&way), reach, |other, chi| {
                sighting.meet(chi, rates.difference(i, other.rate));
            });
        }
    }
}

/// A detection around.
struct Other {
    spot: Spot,
    /// Which scan of the frame's `radar_window`.
    scan: u32,
    /// Whether distances from it are horizontal, for either radar measures no elevation.
    level: bool,
    /// Compensated range rate, m/s; NaN where none was measured.
    rate: f64,
}

/// Detections around, to be searched.
struct Cloud<'a> {
    index: Cow<'a, NeighborIndex>,
    /// In the order of the index.
    others: Vec<Other>,
}

impl<'a> Cloud<'a> {
    /// The identities of the index are places in the lists of the detections around.
    fn new(index: Cow<'a, NeighborIndex>, around: &NeighbouringDetections, level: &[bool]) -> Self {
        let other = |id: &u32| {
            let (id, scan) = (*id as usize, around.scans[*id as usize]);
            let spot = Spot::new(&around.detections[id]);
            Other { spot, scan, level: level[scan as usize], rate: around.doppler[id] }
        };
        Self { others: index.ids().iter().map(other).collect(), index }
    }

    /// Visits what lies within [`FARTHEST`] of a detection at a place, and within `reach`, m, with its distance.
    fn each_near(&self, p: &Point, spot: &Spot, reach: f32, mut visit: impl FnMut(&Other, f64)) {
        self.index.each_beside([p.x as f32, p.y as f32], reach, |at, _| {
            let other = &self.others[at];
            if let Some(chi) = chi_within(FARTHEST, spot, &other.spot, other.level) {
                visit(other, chi);
            }
        });
    }
}

/// The detections of each scan that the frame's own radar made.
fn own_scans<'a>(around: &NeighbouringDetections, level: &[bool]) -> Vec<Option<Cloud<'a>>> {
    let mut begin = 0;
    let mut scans = Vec::with_capacity(around.own.len());
    for (scan, own) in (0u32..).zip(&around.own) {
        let end = begin + around.scans[begin..].partition_point(|of| *of <= scan);
        scans.push(own.then(|| {
            let place = |detection: &Detection| detection.position.coords.cast::<f32>().into();
            let places: Vec<[f32; 3]> = around.detections[begin..end].iter().map(place).collect();
            let ids: Vec<u32> = (begin as u32..end as u32).collect();
            Cloud::new(Cow::Owned(NeighborIndex::new(&places, &ids)), around, level)
        }));
        begin = end;
    }
    scans
}
