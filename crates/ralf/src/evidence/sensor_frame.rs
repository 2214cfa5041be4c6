//! What moves along with the radar: side lobes of the vehicle itself, its bumper, interference. It lies at the same
//! place of the radar's own frame again and again, however the vehicle moves.

use super::chance::{AROUND, SAME, excess_of};
use super::distance::{ROOM, Spot, chi_within, farthest_within, largest_variance};
use crate::scene::{Detection, Frame, index_of};
use crate::sensors::Elevation;
use crate::space::{NeighborIndex, Transform};

/// What stands still has moved on if it is farther than this from its old place, in standard deviations.
const MOVED_ON: f64 = 3.0;

/// The detections of a radar's own scans around, each in the vehicle frame at its own time, in which the radar doesn't
/// move.
pub(super) struct Unmoved {
    /// Whether the radar measures no elevation.
    level: bool,
    /// In the order of the index: each detection, and its scan among the radar's own.
    spots: Vec<Spot>,
    scans: Vec<u32>,
    /// No horizontal variance of these is larger, m^2.
    max_variance: f64,
    /// Of each of the radar's own scans: the way from the vehicle frame at the frame's time to that at its own.
    scans_from_vehicle: Vec<Transform>,
    index: NeighborIndex,
}

/// What is known of each scan, for the detection at hand.
#[derive(Clone, Copy, Default)]
struct Known {
    /// What stood still had moved on.
    moved_on: bool,
    /// Something lies at the same place.
    again: bool,
}

impl Unmoved {
    /// The radar's own scans around a frame.
    pub(super) fn new(frame: &Frame) -> Self {
        let (mut detections, mut scans, mut scans_from_vehicle) = (Vec::<&Detection>::new(), vec![], vec![]);
        for (scan, neighbour) in (0u32..).zip(frame.own_scans_around()) {
            detections.extend(neighbour.scan.detections.iter().flatten());
            scans.resize(detections.len(), scan);
            scans_from_vehicle.push(neighbour.vehicle_from_scan.inverse());
        }
        let index = index_of(detections.iter().map(|detection| &detection.position), Elevation::None);
        let in_order = || index.ids().iter().map(|id| *id as usize);
        let spots: Vec<Spot> = in_order().map(|id| Spot::new(detections[id])).collect();
        Self {
            level: frame.radar.elevation == Elevation::None,
            scans: in_order().map(|id| scans[id]).collect(),
            max_variance: largest_variance(spots.iter()),
            spots,
            scans_from_vehicle,
            index,
        }
    }

    /// How many of the scans in which what stands still had moved on have a detection at the same place of the radar's
    /// frame, over how many would by chance; a logarithm. `None` where it had moved on in none.
    pub(super) fn excess_at(&self, detection: &Detection) -> Option<f64> {
        let spot = Spot::new(detection);
        let known = |way| Known { moved_on: moves_on(detection, &spot, way), again: false };
        let mut known: Vec<Known> = self.scans_from_vehicle.iter().map(known).collect();
        let scans = known.iter().filter(|scan| scan.moved_on).count();
        if scans == 0 {
            return None;
        }
        let mut near = 0;
        let place = [detection.position.x as f32, detection.position.y as f32];
        let reach = farthest_within(SAME, &spot, self.max_variance);
        self.index.each_beside(place, AROUND as f32, |at, distance_squared| {
            let scan = &mut known[self.scans[at] as usize];
            near += usize::from(scan.moved_on);
            if scan.moved_on && !scan.again && distance_squared <= reach * reach {
                scan.again = chi_within(SAME, &spot, &self.spots[at], self.level).is_some();
            }
        });
        let hits = known.iter().filter(|scan| scan.again).count();
        Some(excess_of(hits, scans, near, detection))
    }
}

/// Whether a detection that stands still is elsewhere in the vehicle frame at another time, by more than its
/// uncertainty in any direction explains.
fn moves_on(detection: &Detection, spot: &Spot, scan_from_vehicle: &Transform) -> bool {
    let way = scan_from_vehicle * detection.position - detection.position;
    way.norm_squared() > MOVED_ON * MOVED_ON * (2.0 * spot.variance + ROOM * ROOM)
}
