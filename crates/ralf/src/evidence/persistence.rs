//! What exists is seen again: of the scans that could have seen a detection, how many did, from where, and would chance
//! have done as well?

use super::chance::{AROUND, SAME, excess_of};
use super::columns::{set, unobserved};
use super::recurrence::{FARTHEST, Sighting};
use super::sensor_frame::Unmoved;
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{Detection, Frame, NeighbouringDetections, NeighbouringScan};
use crate::space::Vector;

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
            "the same if it moved along its ray at its range rate, by detections whose range rate agrees",
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
    let own_scans: Vec<bool> =
        surroundings.neighbours().radars.iter().map(|radar| frame.is_own(*radar)).collect();
    let mut columns = unobserved(PIECE.features, frame.scan.len());
    for (i, detection) in frame.scan.detections.iter().enumerate() {
        let Some(detection) = detection else { continue };
        let seen = surroundings.sightings()[i].as_slice();
        let own = || seen.iter().filter(|sighting| sighting.own);
        let others = seen.iter().filter(|sighting| !sighting.own);
        let has_rate = surroundings.rates().is_some_and(|rates| rates.residual(i).is_some());
        let values = [
            share(own().map(|sighting| sighting.still <= SAME)),
            share(own().filter(|_| has_rate).map(|sighting| sighting.moving <= SAME)),
            share(others.map(|sighting| sighting.still <= SAME)),
            mean(own().map(|sighting| sighting.still.min(FARTHEST))),
            excess(surroundings.neighbours(), &own_scans, detection, seen),
            aspect(frame, &origins, detection, seen),
            unmoved.excess_at(detection),
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

/// Of the radar's own scans around, which `own_scans` tells.
fn excess(
    around: &NeighbouringDetections,
    own_scans: &[bool],
    detection: &Detection,
    seen: &[Sighting],
) -> Option<f64> {
    let own: Vec<&Sighting> = seen.iter().filter(|sighting| sighting.own).collect();
    if own.is_empty() {
        return None;
    }
    let mut near = Vec::new();
    let place = [detection.position.x as f32, detection.position.y as f32];
    around.index.beside(place, AROUND as f32, &mut near);
    let near = near.iter().filter(|id| own_scans[around.scans[**id as usize] as usize]).count();
    let hits = own.iter().filter(|sighting| sighting.still <= SAME).count();
    Some(excess_of(hits, own.len(), near, detection))
}

/// Where each scan around was made, in the vehicle frame at the frame's time, m.
fn origins(frame: &Frame) -> Vec<Vector> {
    let mounting = |radar: usize| frame.rig.radars[radar].vehicle_from_radar;
    let origin = |scan: &NeighbouringScan| (scan.vehicle_from_scan * mounting(scan.radar)).translation.vector;
    frame.radar_window.iter().map(origin).collect()
}

/// `None` where no scan could have seen it from elsewhere.
fn aspect(frame: &Frame, origins: &[Vector], detection: &Detection, seen: &[Sighting]) -> Option<f64> {
    let ray = detection.position.coords - frame.radar.vehicle_from_radar.translation.vector;
    let angle =
        |sighting: &Sighting| ray.angle(&(detection.position.coords - origins[sighting.scan as usize]));
    let largest = seen.iter().map(angle).fold(0.0, f64::max);
    let again = seen.iter().filter(|sighting| sighting.still <= SAME).map(angle).fold(0.0, f64::max);
    (largest > ELSEWHERE).then(|| again / largest)
}
