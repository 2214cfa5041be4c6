//! How far a detection lies from what stands still around it: the LiDAR scans of the seconds around put together,
//! without the ground and what moved.

use super::columns::{set, unobserved};
use super::probe::Probe;
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{ColumnGrid, StaticMap};
use crate::space::Neighbor;
use nalgebra::{Matrix3, Vector3};
use std::f64::consts::TAU;

const GROUP: &str = "LiDAR map";
/// No distance is larger, m.
const FARTHEST: f64 = 10.0;
/// No Mahalanobis distance is larger.
const LARGEST_CHI: f64 = 10.0;
/// Of so many points, the nearest ones, the Mahalanobis distance is taken.
const CANDIDATES: usize = 12;
/// LiDAR and radar don't see the same spot of an object, m.
const SAME_SPOT: f64 = 0.1;
/// Columns nearer than this count for what surrounds a detection, m.
const AROUND: f64 = 3.0;
/// Columns nearer than this count for the density, m.
const BESIDE: f64 = 0.5;
/// The nearest column's heights are told if it is nearer than this, m.
const NEAR: f64 = 1.0;

pub(super) const PIECE: Piece = Piece { features: FEATURES, observe };

const FEATURES: &[Feature] = &[
    Feature {
        name: "map_distance",
        unit: "m",
        group: GROUP,
        meaning: "distance from the nearest point of the static map, at most 10; null beyond the map",
    },
    Feature {
        name: "map_chi",
        unit: "sigma",
        group: GROUP,
        meaning: "least Mahalanobis distance from the points of the static map near by, at most 10",
    },
    Feature {
        name: "map_column_distance",
        unit: "m",
        group: GROUP,
        meaning: "horizontal distance from the nearest column in which something stands, at most 3",
    },
    Feature {
        name: "map_column_sigmas",
        unit: "sigma",
        group: GROUP,
        meaning: "horizontal distance from the nearest column in which something stands, in standard deviations along \
                  it",
    },
    Feature {
        name: "map_column_top",
        unit: "m",
        group: GROUP,
        meaning: "height above the ground up to which the nearest column is filled, where one is within a metre",
    },
    Feature {
        name: "map_column_bottom",
        unit: "m",
        group: GROUP,
        meaning: "height above the ground from which the nearest column is filled, where one is within a metre",
    },
    Feature {
        name: "map_density",
        unit: "1",
        group: GROUP,
        meaning: "logarithm of one more than the voxels that are filled within half a metre, at any height",
    },
    Feature {
        name: "map_octants",
        unit: "share",
        group: GROUP,
        meaning: "share of the eight directions in which something stands within 3 m",
    },
];

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(FEATURES, frame.scan.len());
    let Some(lidar) = &frame.lidar_window else { return columns };
    let map = lidar.window.map();
    let mut found = Vec::new();
    for (i, probe) in surroundings.probes().iter().enumerate() {
        let Some(probe) = probe else { continue };
        let p = probe.detection.position;
        if !ColumnGrid::covers(p.x, p.y) {
            continue;
        }
        let (distance, chi) = nearest_point(map, probe, &mut found);
        let [a, b, c, d, e, f] = around(map, probe);
        set(&mut columns, i, [Some(distance), Some(chi), a, b, c, d, e, f]);
    }
    columns
}

/// The Euclidean distance from the nearest point, and the least Mahalanobis distance.
fn nearest_point(map: &StaticMap, probe: &Probe, found: &mut Vec<Neighbor>) -> (f64, f64) {
    let detection = &probe.detection;
    let query = detection.position.coords.cast::<f32>().into();
    map.index.nearest_within(query, CANDIDATES, FARTHEST as f32, found);
    let nearest = found.first().map_or(FARTHEST, |neighbor| f64::from(neighbor.distance_squared).sqrt());
    let covariance = detection.axes * detection.axes.transpose() + Matrix3::identity() * SAME_SPOT.powi(2);
    let Some(precision) = covariance.try_inverse() else { return (nearest.min(FARTHEST), LARGEST_CHI) };
    let mut least = LARGEST_CHI * LARGEST_CHI;
    for neighbor in found.iter() {
        let point = Vector3::from(map.points[neighbor.id as usize].map(f64::from));
        let h = point - detection.position.coords;
        least = least.min(h.dot(&(precision * h)));
    }
    (nearest.min(FARTHEST), least.max(0.0).sqrt())
}

/// What the columns say: distance, the same in sigmas, top, bottom, density, octants.
fn around(map: &StaticMap, probe: &Probe) -> [Option<f64>; 6] {
    let p = probe.detection.position;
    let mut nearest = None;
    let mut least = AROUND;
    let mut octants = 0u8;
    let mut voxels = 0u32;
    for ([x, y], column) in map.columns.around(p.x, p.y, AROUND) {
        let distance = x.hypot(y);
        if distance > AROUND {
            continue;
        }
        octants |= 1 << ((y.atan2(x) / TAU).rem_euclid(1.0) * 8.0).min(7.0) as u8;
        voxels += if distance <= BESIDE { u32::from(column.voxels) } else { 0 };
        if distance < least {
            least = distance;
            nearest = Some(([x, y], column));
        }
    }
    let sigmas = nearest.map(|([x, y], _)| {
        let direction = Vector3::new(x, y, 0.0).try_normalize(1e-6).unwrap_or_else(Vector3::x);
        least / probe.detection.sigma_along(&direction).hypot(SAME_SPOT)
    });
    let near = nearest.map(|(_, column)| column).filter(|_| least <= NEAR);
    [
        Some(least),
        Some(sigmas.unwrap_or(LARGEST_CHI).min(LARGEST_CHI)),
        near.map(|column| f64::from(column.top)),
        near.map(|column| f64::from(column.bottom)),
        Some(f64::from(voxels).ln_1p()),
        Some(f64::from(octants.count_ones()) / 8.0),
    ]
}
