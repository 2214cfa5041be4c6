//! What moves along with the radar: side lobes of the vehicle itself, its bumper, interference. It lies at the same
//! place of the radar's own frame again and again, however the vehicle moves.

use super::chance::{AROUND, SAME, excess_of};
use super::cloud::Cloud;
use super::distance::{ROOM, Spot, chi_within};
use crate::scene::{Detection, Frame, index_of};
use crate::sensors::Elevation;
use crate::space::Transform;
use std::borrow::Cow;

/// What stands still has moved on if it is farther than this from its old place, in standard deviations.
const MOVED_ON: f64 = 3.0;

/// The detections of a radar's own scans around, each in the vehicle frame at its own time, in which the radar doesn't
/// move.
pub(super) struct Unmoved {
    /// Whether the radar measures no elevation.
    level: bool,
    cloud: Cloud<'static>,
    /// In the order of the cloud: to which of the radar's own scans a detection belongs.
    scan_at: Vec<u32>,
    /// Of each of the radar's own scans: the way from the vehicle frame at the frame's time to that at its own.
    scans_from_vehicle: Vec<Transform>,
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
        let cloud = Cloud::new(Cow::Owned(index), |id| detections[id]);
        let scan_at = cloud.in_order(|id| scans[id]).collect();
        let level = frame.radar.elevation == Elevation::None;
        Self { level, cloud, scan_at, scans_from_vehicle }
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
        let near = self.count_around(detection, &known);
        self.cloud.each_near(&spot, SAME, AROUND as f32, |at, other| {
            let scan = &mut known[self.scan_at[at] as usize];
            if scan.moved_on && !scan.again {
                scan.again = chi_within(SAME, &spot, other, self.level).is_some();
            }
        });
        let hits = known.iter().filter(|scan| scan.again).count();
        Some(excess_of(hits, scans, near, detection))
    }

    /// How many detections of the scans in which it had moved on lie around a place.
    fn count_around(&self, detection: &Detection, known: &[Known]) -> usize {
        let (place, index, radius) = (detection.in_plan(), self.cloud.index(), AROUND as f32);
        let is_left_out = |scan: &Known| !scan.moved_on;
        let Some(first) = known.iter().position(is_left_out) else {
            return index.count_beside(place, radius);
        };
        // Scans are in time order, so that those in which it had not moved on mostly follow each other.
        let left_out = known[first..].iter().take_while(|scan| is_left_out(scan)).count();
        if known[first + left_out..].iter().any(is_left_out) {
            let counts = |scan: u32| known[scan as usize].moved_on;
            return index.count_beside_where(place, radius, &self.scan_at, counts);
        }
        let (first, left_out) = (first as u32, left_out as u32);
        let counts = |scan: u32| scan.wrapping_sub(first) >= left_out;
        index.count_beside_where(place, radius, &self.scan_at, counts)
    }
}

/// Whether a detection that stands still is elsewhere in the vehicle frame at another time, by more than its
/// uncertainty in any direction explains.
fn moves_on(detection: &Detection, spot: &Spot, scan_from_vehicle: &Transform) -> bool {
    let way = scan_from_vehicle * detection.position - detection.position;
    way.norm_squared() > MOVED_ON * MOVED_ON * (2.0 * spot.variance + ROOM * ROOM)
}
