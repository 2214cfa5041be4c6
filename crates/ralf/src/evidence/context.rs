//! A detection among those of its scan: how crowded it is there, and which stronger echoes could have made it.
//!
//! Strong echoes cast others. What lies behind one at its azimuth may be a path that took a turn, or the echo that went
//! to and fro twice and so lies twice as far; what lies beside one at its range and range rate may be a side lobe.

use super::columns::{set, unobserved};
use super::echoes::Echoes;
use super::statistics::ranks;
use super::{Feature, Piece, Surroundings, Values};

pub(super) const PIECE: Piece = Piece {
    features: &[
        feature(
            "context_density_rank",
            "1",
            "share of the scan's other detections that have fewer others within 3 m, seen from above",
        ),
        feature(
            "context_density_around",
            "1",
            "share of the scan's other detections with fewer detections of all radars' scans around within 1.5 m",
        ),
        feature(
            "context_before",
            "1",
            "how many detections of the scan lie before it at its azimuth and have a larger cross-section",
        ),
        feature("context_before_distance", "m", "distance along the ray from the nearest of these"),
        feature(
            "context_double_bounce",
            "sigma",
            "distance of its range from twice that of one of these, of which the least",
        ),
        feature(
            "context_beside_rank",
            "1",
            "share of the scan's other detections at its range whose power is smaller",
        ),
        feature(
            "context_beside_angle",
            "deg",
            "angle to the nearest detection of the scan at its range that has more power",
        ),
        feature(
            "context_side_lobe",
            "dB",
            "by how much the strongest detection of the scan at its range and range rate, but at another azimuth, has \
             more power",
        ),
    ],
    observe,
};

/// Own detections within this make a place crowded, m.
const CROWD: f64 = 3.0;
/// Detections around within this lie on the same thing, m.
const NEAR: f64 = 1.5;

const fn feature(name: &'static str, unit: &'static str, meaning: &'static str) -> Feature {
    Feature { name, unit, group: "Context", meaning }
}

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let density = ranks(&crowd(surroundings));
    let around = ranks(&crowd_around(surroundings));
    let echoes = Echoes::new(surroundings);
    let mut columns = unobserved(PIECE.features, frame.scan.len());
    for i in 0..frame.scan.len() {
        let before = echoes.as_ref().map(|echoes| echoes.before(i)).unwrap_or_default();
        let beside = echoes.as_ref().map(|echoes| echoes.beside(i)).unwrap_or_default();
        let values = [
            density[i],
            around[i],
            before.count,
            before.distance,
            before.double_bounce,
            beside.rank,
            beside.angle,
            beside.side_lobe,
        ];
        set(&mut columns, i, values);
    }
    columns
}

/// How many others of the scan lie near each detection; NaN for one without a place.
fn crowd(surroundings: &Surroundings) -> Vec<f64> {
    let mut crowd = vec![f64::NAN; surroundings.frame.scan.len()];
    for (row, detection) in surroundings.rows_by_place() {
        crowd[row] = surroundings.count_beside(detection, CROWD) as f64 - 1.0;
    }
    crowd
}

/// How many detections of all scans around lie near each detection; NaN for one without a place, and without scans
/// around.
fn crowd_around(surroundings: &Surroundings) -> Vec<f64> {
    let around = surroundings.neighbours();
    let mut crowd = vec![f64::NAN; surroundings.frame.scan.len()];
    if around.radars.is_empty() {
        return crowd;
    }
    for (row, detection) in surroundings.rows_by_place() {
        crowd[row] = around.index.count_beside(detection.in_plan(), NEAR as f32) as f64;
    }
    crowd
}
