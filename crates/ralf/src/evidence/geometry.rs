//! Where a detection lies in what its radar can see. Radars see ghosts where they see worst: near, at the sides, high
//! and low.

use super::columns::{set, unobserved};
use super::{Feature, Piece, Surroundings, Values};
use crate::sensors::{Elevation, Radar};
use crate::space::Spherical;

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
            "angle above the radar's axis, as a share of half its vertical field of view; null for a radar without \
             elevation",
        ),
        feature("geometry_sigma_across", "m", "standard deviation of the place across the ray, horizontally"),
    ],
    observe,
};

const fn feature(name: &'static str, unit: &'static str, meaning: &'static str) -> Feature {
    Feature { name, unit, group: "Geometry", meaning }
}

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(PIECE.features, frame.scan.len());
    for (i, place) in frame.scan.measured.spherical.iter().enumerate() {
        if frame.scan.detections[i].is_some() {
            set(&mut columns, i, of_place(frame.radar, place));
        }
    }
    columns
}

/// One value per feature.
fn of_place(radar: &Radar, place: &Spherical) -> [Option<f64>; 4] {
    let elevation = place.elevation / (0.5 * radar.fov_elevation);
    [
        Some(place.range),
        Some(place.azimuth.abs() / (0.5 * radar.fov_azimuth)),
        Some(elevation).filter(|_| radar.elevation == Elevation::Measured),
        Some(place.range * place.elevation.cos() * radar.sigma_azimuth),
    ]
}
