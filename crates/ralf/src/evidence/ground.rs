//! Where a detection lies above the ground: a surface that follows slopes and kerbs, from the LiDAR scans of the
//! seconds around.

use super::{Feature, Piece, Surroundings, Values};
use crate::sensors::Elevation;
use crate::space::Vector;

/// What the surface itself may be off by, m.
const SURFACE_SIGMA: f64 = 0.05;

pub(super) const PIECE: Piece = Piece {
    features: &[
        Feature {
            name: "ground_height",
            unit: "m",
            group: "Ground",
            meaning: "height above the ground surface; null for a radar without elevation, and far from all ground \
                      that was seen",
        },
        Feature {
            name: "ground_height_sigmas",
            unit: "sigma",
            group: "Ground",
            meaning: "height above the ground surface, in standard deviations of the detection's height",
        },
        Feature {
            name: "ground_step",
            unit: "m",
            group: "Ground",
            meaning: "difference of the highest and the lowest ground within half a metre: kerbs, ramps, feet of walls",
        },
        Feature {
            name: "ground_unseen",
            unit: "m",
            group: "Ground",
            meaning: "distance from the nearest place whose ground was seen",
        },
    ],
    observe,
};

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = vec![vec![None; frame.scan.len()]; 4];
    let Some(lidar) = &frame.lidar_window else { return columns };
    let Some(ground) = lidar.window.ground() else { return columns };
    let measured = frame.radar.elevation == Elevation::Measured;
    for (i, detection) in frame.scan.detections.iter().enumerate() {
        let Some(detection) = detection else { continue };
        let p = lidar.to_window(&detection.position);
        let height = ground.height(&p).filter(|_| measured);
        let sigma = detection.sigma_along(&Vector::z()).hypot(SURFACE_SIGMA);
        columns[0][i] = height;
        columns[1][i] = height.map(|height| height / sigma);
        columns[2][i] = ground.step_at(p.x, p.y);
        columns[3][i] = ground.unseen_at(p.x, p.y);
    }
    columns
}
