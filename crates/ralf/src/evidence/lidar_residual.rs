//! How far a detection lies from the LiDAR's points: in metres from the nearest, and in height and in the plane, each
//! in its own standard deviations.
//!
//! The paper's `d_lm` is one number for both. Real radars measure elevation much worse than range and azimuth, and
//! ghosts below the road or above a wall are far off in height alone.

use super::columns::{set, unobserved};
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::mismatch;
use crate::sensors::Elevation;
use crate::space::Vector;

/// Where no point is as near as this, m, there is no residual: a search that need not go on costs little.
const NEAR: f64 = 5.0;

pub(super) const PIECE: Piece = Piece {
    features: &[
        Feature {
            name: "lidar_distance",
            unit: "m",
            group: "LiDAR rays",
            meaning: "distance from the nearest LiDAR point above the ground, of a radar without elevation the \
                      horizontal one; null where none is within 5 m",
        },
        Feature {
            name: "lidar_residual_horizontal",
            unit: "sigma",
            group: "LiDAR rays",
            meaning: "mean horizontal distance from the K nearest LiDAR points above the ground, in standard \
                      deviations along it; null where none is within 5 m",
        },
        Feature {
            name: "lidar_residual_vertical",
            unit: "sigma",
            group: "LiDAR rays",
            meaning: "mean height over the K nearest LiDAR points above the ground, in standard deviations of height; \
                      null for a radar without elevation, and where none is within 5 m",
        },
    ],
    observe,
};

/// The mismatch (docs/method.md, section 3) of the residual's horizontal and vertical part, meaned over the `K` nearest
/// points. Floor detections have theirs, too.
fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let (frame, config) = (surroundings.frame, surroundings.config);
    let mut columns = unobserved(PIECE.features, frame.scan.len());
    let Some(cloud) = frame.lidar_cloud() else { return columns };
    let is_level = frame.radar.elevation == Elevation::None;
    let mut association = cloud.association(config.lidar.neighbours);
    association.set_reach(NEAR);
    for (i, detection) in surroundings.rows_by_place() {
        let spread = detection.spread();
        let (mut across, mut up) = (0.0, 0.0);
        let nearest = cloud.nearest(&mut association, detection);
        let Some(way) = nearest.first().map(|first| detection.position - first.position) else { continue };
        let distance = if is_level { way.xy().norm() } else { way.norm() };
        if distance > NEAR {
            continue;
        }
        for reference in &nearest {
            let h = detection.position - reference.position;
            across += mismatch(&Vector::new(h.x, h.y, 0.0), &spread, &reference.spread);
            up += mismatch(&Vector::new(0.0, 0.0, h.z), &spread, &reference.spread).copysign(h.z);
        }
        let [horizontal, vertical] = [across, up].map(|sum| sum / nearest.len() as f64);
        let vertical = Some(vertical).filter(|_| !is_level);
        set(&mut columns, i, [Some(distance), Some(horizontal), vertical]);
    }
    columns
}
