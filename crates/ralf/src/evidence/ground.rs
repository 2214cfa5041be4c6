//! Where a detection lies above the ground: a surface that follows slopes and kerbs, from the LiDAR scans of the
//! seconds around.

use super::columns::{set, unobserved};
use super::{Feature, Piece, Surroundings, Values};
use crate::sensors::Elevation;
use crate::space::Vector;

/// What the surface itself may be off by, m.
const SURFACE_SIGMA: f64 = 0.05;

pub(super) const PIECE: Piece = Piece { features: FEATURES, observe };

const FEATURES: &[Feature] = &[
    Feature {
        name: "ground_height",
        unit: "m",
        group: "Ground",
        meaning: "height above the ground surface; null for a radar without elevation, and far from all ground that \
                  was seen",
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
];

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(FEATURES, frame.scan.len());
    let Some(lidar) = &frame.lidar_window else { return columns };
    let Some(ground) = lidar.window.ground() else { return columns };
    let measured = frame.radar.elevation == Elevation::Measured;
    for (i, detection) in frame.scan.detections.iter().enumerate() {
        let Some(detection) = detection else { continue };
        let p = lidar.to_window(&detection.position);
        let height = ground.height(&p).filter(|_| measured);
        let sigma = detection.sigma_along(&Vector::z()).hypot(SURFACE_SIGMA);
        let values = [
            height,
            height.map(|height| height / sigma),
            ground.step_at(p.x, p.y),
            ground.unseen_at(p.x, p.y),
        ];
        set(&mut columns, i, values);
    }
    columns
}
