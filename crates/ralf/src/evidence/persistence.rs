//! What exists is seen again: of the scans that could have seen a detection, how many did, from where, and would chance
//! have done as well?

use super::chance::{AROUND, SAME, excess_of};
use super::columns::{set, unobserved};
use super::meeting::FARTHEST;
use super::recurrence::{Recurrence, Sighting};
use super::sensor_frame::Unmoved;
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{Detection, Frame, NeighbouringDetections, NeighbouringScan, index_of};
use crate::sensors::Elevation;
use crate::space::{NeighborIndex, Vector};
use std::borrow::Cow;

pub(super) const PIECE: Piece = Piece {
    features: &[
        feature(
            "persistence_own",
            "1",
            "share of the radar's own scans around that could have seen the detection again and did, if it stood still",
        ),
        feature(
            "persistence_moving",
            "1",
            "of what moves: the same where its range rate takes it along the ray or along the vehicle's course, \
             whichever fits better, by detections whose range rate agrees; of what stands still where it stands",
        ),
        feature(
            "persistence_others",
            "1",
            "share of the other radars' scans around that could have seen the detection and did, if it stood still",
        ),
        feature(
            "persistence_distance",
            "sigma",
            "mean distance from the nearest detection of each of the radar's own scans around that could have seen it, \
             each at most 3",
        ),
        feature(
            "persistence_excess",
            "1",
            "logarithm of how many of the radar's own scans saw it again, over how many would by chance, as densely as \
             detections lie within 5 m",
        ),
        feature(
            "persistence_aspect",
            "1",
            "largest angle between the radar's ray and those of the scans that saw it again, as a share of the largest \
             of the scans that could have, the other radars' too; null where none looked from elsewhere",
        ),
        feature(
            "persistence_sensor",
            "1",
            "logarithm of how many of the radar's own scans detected something at the same place of the radar's frame, \
             over how many would by chance, of those in which what stands still had moved on; high for side lobes and \
             for the vehicle itself",
        ),
        feature(
            "persistence_shift",
            "sigma",
            "distance from where the radar's own scans around that saw it again together place what stands still",
        ),
        feature(
            "persistence_scatter",
            "sigma",
            "how far the places in these scans scatter about that joint place, root mean square along each axis; null \
             where none saw it again",
        ),
    ],
    observe,
};

/// Rays that differ by no more look from the same place, rad.
const ELSEWHERE: f64 = 0.01;

const fn feature(name: &'static str, unit: &'static str, meaning: &'static str) -> Feature {
    Feature { name, unit, group: "Persistence", meaning }
}

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let (origins, unmoved) = (origins(frame), Unmoved::new(frame));
    let own_around = own_around(surroundings.neighbours());
    let mut columns = unobserved(PIECE.features, frame.scan.len());
    for (i, detection) in surroundings.rows_by_place() {
        let Recurrence { seen, met, joint } = &surroundings.recurrences()[i];
        let own = || seen.iter().filter(|sighting| sighting.own);
        let others = seen.iter().filter(|sighting| !sighting.own);
        let values = [
            share(own().map(|sighting| sighting.still <= SAME)),
            share(met.iter().map(|meeting| meeting.chi <= SAME)),
            share(others.map(|sighting| sighting.still <= SAME)),
            mean(own().map(|sighting| sighting.still.min(FARTHEST))),
            excess(&own_around, detection, seen),
            aspect(frame, &origins, detection, seen),
            unmoved.excess_at(detection),
            joint.map(|joint| joint.shift),
            joint.and_then(|joint| joint.scatter),
        ];
        set(&mut columns, i, values);
    }
    columns
}

fn share(answers: impl Iterator<Item = bool>) -> Option<f64> {
    mean(answers.map(|answer| f64::from(u8::from(answer))))
}

fn mean(values: impl Iterator<Item = f64>) -> Option<f64> {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value| (sum + value, count + 1));
    (count > 0).then(|| sum / f64::from(count))
}

/// An index of the radar's own detections alone.
fn own_around(around: &NeighbouringDetections) -> Cow<'_, NeighborIndex> {
    if around.own.iter().all(|own| *own) {
        return Cow::Borrowed(&around.index);
    }
    let detections = around.detections.iter().zip(&around.scans);
    let own = detections.filter(|(_, scan)| around.own[**scan as usize]);
    Cow::Owned(index_of(own.map(|(detection, _)| &detection.position), Elevation::None))
}

/// `own_around` holds the detections of the radar's own scans around.
fn excess(own_around: &NeighborIndex, detection: &Detection, seen: &[Sighting]) -> Option<f64> {
    let own = seen.iter().filter(|sighting| sighting.own).count();
    if own == 0 {
        return None;
    }
    let near = own_around.count_beside(detection.in_plan(), AROUND as f32);
    let hits = seen.iter().filter(|sighting| sighting.own && sighting.still <= SAME).count();
    Some(excess_of(hits, own, near, detection))
}

/// Where each scan around was made, in the vehicle frame at the frame's time, m.
fn origins(frame: &Frame) -> Vec<Vector> {
    let mounting = |radar: usize| frame.rig.radars[radar].vehicle_from_radar;
    let origin = |scan: &NeighbouringScan| (scan.vehicle_from_scan * mounting(scan.radar)).translation.vector;
    frame.radar_window.iter().map(origin).collect()
}

/// `None` where no scan could have seen it from elsewhere.
fn aspect(frame: &Frame, origins: &[Vector], detection: &Detection, seen: &[Sighting]) -> Option<f64> {
    let place = &detection.position.coords;
    let ray = place - frame.radar.vehicle_from_radar.translation.vector;
    let length = ray.norm();
    // The least cosines: of all, and of those that saw it again.
    let (mut largest, mut again) = (1.0f64, 1.0f64);
    for sighting in seen {
        let other = place - origins[sighting.scan as usize];
        let cosine = ray.dot(&other) / (length * other.norm());
        // Of a scan that was made at the very place `min` passes over the quotient, which is no number.
        largest = largest.min(cosine);
        if sighting.still <= SAME {
            again = again.min(cosine);
        }
    }
    let [largest, again] = [largest, again].map(|cosine| cosine.max(-1.0).acos());
    (largest > ELSEWHERE).then(|| again / largest)
}
