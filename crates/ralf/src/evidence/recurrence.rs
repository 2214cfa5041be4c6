//! Where the radars' scans around could have seen a detection again, and whether they did.

use super::distance::{ROOM, chi_within, horizontal_variance};
use super::rates::{AGREEING, Rates};
use crate::scene::{Detection, Frame, NeighbouringDetections, NeighbouringScan, Reach, Sight};
use crate::sensors::{Elevation, Radar};
use crate::space::Point;

/// Nothing farther is looked for, in standard deviations.
pub(super) const FARTHEST: f64 = 3.0;
/// Nor anything farther than this, m, whatever the radar's uncertainty is said to be.
const REACH: f64 = 8.0;
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

/// The sightings of each detection of a frame, in the order of the scans; none of a detection without a place. `rates`
/// are those of the frame's scan.
pub(super) fn sightings(
    frame: &Frame,
    around: &NeighbouringDetections,
    rates: Option<&Rates>,
) -> Vec<Vec<Sighting>> {
    let reaches = reaches(frame);
    let sight =
        |scan: &NeighbouringScan| Sight::new(&frame.rig.radars[scan.radar], scan, &reaches[scan.radar]);
    let sights: Vec<Sight> = frame.radar_window.iter().map(sight).collect();
    let mut search = Search::new(frame, around, rates);
    let mut all = Vec::with_capacity(frame.scan.len());
    for (i, detection) in frame.scan.detections.iter().enumerate() {
        let Some(detection) = detection else {
            all.push(Vec::new());
            continue;
        };
        let mut seen: Vec<Sighting> = Vec::new();
        for (scan, sight) in (0u32..).zip(&sights) {
            if sight.covers(&detection.position) {
                seen.push(Sighting::nothing(scan, frame.is_own(around.radars[scan as usize])));
            }
        }
        search.still(i, detection, &mut seen);
        search.moving(i, detection, &mut seen);
        all.push(seen);
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
    around: &'a NeighbouringDetections,
    rates: Option<&'a Rates>,
    /// The frame's radar, m.
    origin: Point,
    /// Of each scan around: whether distances from its detections are horizontal, for either radar measures no
    /// elevation.
    level: Vec<bool>,
    /// Of the detections around: no horizontal variance is larger, m^2.
    max_variance: f64,
    found: Vec<u32>,
}

impl<'a> Search<'a> {
    fn new(frame: &Frame, around: &'a NeighbouringDetections, rates: Option<&'a Rates>) -> Self {
        let is_level = |radar: &Radar| radar.elevation == Elevation::None;
        let level =
            around.radars.iter().map(|radar| is_level(frame.radar) || is_level(&frame.rig.radars[*radar]));
        Self {
            around,
            rates,
            origin: Point::from(frame.radar.vehicle_from_radar.translation.vector),
            level: level.collect(),
            max_variance: around.detections.iter().map(horizontal_variance).fold(0.0, f64::max),
            found: Vec::new(),
        }
    }

    /// Compares a detection with those that lie where it would be if it stood still.
    fn still(&mut self, i: usize, detection: &Detection, seen: &mut [Sighting]) {
        self.find(detection);
        for &id in &self.found {
            let id = id as usize;
            let Ok(at) = seen.binary_search_by_key(&self.around.scans[id], |sighting| sighting.scan) else {
                continue;
            };
            let sighting = &mut seen[at];
            let Some(chi) = self.chi(detection, id) else { continue };
            sighting.still = sighting.still.min(chi);
            if let Some(rates) = self.rates.filter(|rates| sighting.own && rates.motion(i) == 0.0) {
                sighting.meet(chi, rates.difference(i, self.around.doppler[id]));
            }
        }
    }

    /// Compares a detection that moves with those that lie where it would be then.
    fn moving(&mut self, i: usize, detection: &Detection, seen: &mut [Sighting]) {
        let Some(rates) = self.rates.filter(|rates| rates.motion(i) != 0.0) else { return };
        let ray = (detection.position - self.origin).try_normalize(0.0).unwrap_or_default();
        for sighting in seen.iter_mut().filter(|sighting| sighting.own) {
            let way = rates.motion(i) * self.around.seconds[sighting.scan as usize];
            let moved = Detection { position: detection.position + ray * way, axes: detection.axes };
            self.find(&moved);
            for &id in &self.found {
                let id = id as usize;
                if self.around.scans[id] != sighting.scan {
                    continue;
                }
                if let Some(chi) = self.chi(&moved, id) {
                    sighting.meet(chi, rates.difference(i, self.around.doppler[id]));
                }
            }
        }
    }

    /// Finds all that can lie within [`FARTHEST`].
    fn find(&mut self, detection: &Detection) {
        let variance = horizontal_variance(detection) + self.max_variance + ROOM * ROOM;
        let reach = (FARTHEST * variance.sqrt()).min(REACH);
        let place = [detection.position.x as f32, detection.position.y as f32];
        self.around.index.beside(place, reach as f32, &mut self.found);
    }

    fn chi(&self, detection: &Detection, id: usize) -> Option<f64> {
        let other = &self.around.detections[id];
        chi_within(FARTHEST, detection, other, self.level[self.around.scans[id] as usize])
    }
}
