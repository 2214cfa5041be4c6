//! What moves along with the radar: side lobes of the vehicle itself, its bumper, interference. It lies at the same
//! place of the radar's own frame again and again, however the vehicle moves.

use super::chance::{AROUND, SAME, excess_of};
use super::distance::{ROOM, chi_within, horizontal_variance};
use crate::scene::{Detection, Frame, index_of};
use crate::sensors::Elevation;
use crate::space::{NeighborIndex, Transform};

/// What stands still has moved on if it is farther than this from its old place, in standard deviations.
const MOVED_ON: f64 = 3.0;

/// The detections of a radar's own scans around, each in the vehicle frame at its own time, in which the radar doesn't
/// move.
pub(super) struct Unmoved<'a> {
    frame: &'a Frame<'a>,
    detections: Vec<&'a Detection>,
    /// Of each detection: its scan among the radar's own.
    scans: Vec<usize>,
    /// Of each of the radar's own scans: the way from the vehicle frame at the frame's time to that at its own.
    scans_from_vehicle: Vec<Transform>,
    index: NeighborIndex,
}

impl<'a> Unmoved<'a> {
    /// The radar's own scans around a frame.
    pub(super) fn new(frame: &'a Frame<'a>) -> Self {
        let (mut detections, mut scans, mut scans_from_vehicle) = (Vec::new(), Vec::new(), Vec::new());
        for (scan, neighbour) in frame.own_scans_around().enumerate() {
            for detection in neighbour.scan.detections.iter().flatten() {
                detections.push(detection);
                scans.push(scan);
            }
            scans_from_vehicle.push(neighbour.vehicle_from_scan.inverse());
        }
        let index = index_of(detections.iter().map(|detection| &detection.position), Elevation::None);
        Self { frame, detections, scans, scans_from_vehicle, index }
    }

    /// How many of the scans in which what stands still had moved on have a detection at the same place of the radar's
    /// frame, over how many would by chance; a logarithm. `None` where it had moved on in none.
    pub(super) fn excess_at(&self, detection: &Detection) -> Option<f64> {
        let way = |scan_from_vehicle| moves_on(detection, scan_from_vehicle);
        let moved_on: Vec<bool> = self.scans_from_vehicle.iter().map(way).collect();
        let scans = moved_on.iter().filter(|moved| **moved).count();
        if scans == 0 {
            return None;
        }
        let mut near = Vec::new();
        self.index.beside(
            [detection.position.x as f32, detection.position.y as f32],
            AROUND as f32,
            &mut near,
        );
        near.retain(|id| moved_on[self.scans[*id as usize]]);
        let mut again = vec![false; moved_on.len()];
        let level = self.frame.radar.elevation == Elevation::None;
        for id in near.iter().map(|id| *id as usize) {
            again[self.scans[id]] |= chi_within(SAME, detection, self.detections[id], level).is_some();
        }
        let hits = again.iter().filter(|again| **again).count();
        Some(excess_of(hits, scans, near.len(), detection))
    }
}

/// Whether a detection that stands still is elsewhere in the vehicle frame at another time, by more than its
/// uncertainty in any direction explains.
fn moves_on(detection: &Detection, scan_from_vehicle: &Transform) -> bool {
    let way = scan_from_vehicle * detection.position - detection.position;
    way.norm_squared() > MOVED_ON * MOVED_ON * (2.0 * horizontal_variance(detection) + ROOM * ROOM)
}
