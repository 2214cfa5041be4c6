//! Where a detection lies in what its radar can see. Radars see ghosts where they see worst: near, at the sides, high
//! and low.

use super::columns::{set, unobserved};
use super::course::Course;
use super::{Feature, Piece, Surroundings, Values};
use crate::sensors::{Elevation, Radar};
use crate::space::{Spherical, Vector};

pub(super) const PIECE: Piece = Piece {
    features: &[
        feature("geometry_range", "m", "distance from the radar"),
        feature(
            "geometry_azimuth",
            "1",
            "angle beside the radar's axis, as a share of half its field of view",
        ),
        feature(
            "geometry_elevation",
            "1",
            "angle above the radar's axis, whichever way up the radar is mounted, as a share of half its vertical \
             field of view; null for a radar without elevation",
        ),
        feature("geometry_sigma_across", "m", "standard deviation of the place across the ray, horizontally"),
        feature(
            "geometry_beside_course",
            "m",
            "horizontal distance from the arc on which the vehicle moves, which is straight where it stands; null \
             where its motion isn't known",
        ),
    ],
    observe,
};

const fn feature(name: &'static str, unit: &'static str, meaning: &'static str) -> Feature {
    Feature { name, unit, group: "Geometry", meaning }
}

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(PIECE.features, frame.scan.len());
    let course = Course::of(frame);
    for (i, place) in frame.scan.measured.spherical.iter().enumerate() {
        if let Some(detection) = &frame.scan.detections[i] {
            let beside = course.map(|course| course.beside(&detection.position));
            let [range, azimuth, elevation, across] = of_place(frame.radar, place);
            set(&mut columns, i, [range, azimuth, elevation, across, beside]);
        }
    }
    columns
}

/// What the radar's own frame tells.
fn of_place(radar: &Radar, place: &Spherical) -> [Option<f64>; 4] {
    let above = if is_upright(radar) { place.elevation } else { -place.elevation };
    let elevation = above / (0.5 * radar.fov_elevation);
    [
        Some(place.range),
        Some(place.azimuth.abs() / (0.5 * radar.fov_azimuth)),
        Some(elevation).filter(|_| radar.elevation == Elevation::Measured),
        Some(place.range * place.elevation.cos() * radar.sigma_azimuth),
    ]
}

/// Whether the radar's upper side is the vehicle's: radars are mounted upside down as well.
fn is_upright(radar: &Radar) -> bool {
    (radar.vehicle_from_radar.rotation * Vector::z()).z >= 0.0
}
