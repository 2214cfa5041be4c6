//! Where a detection lies above the ground: a surface that follows slopes and kerbs, from the LiDAR scans of the
//! seconds around.

use super::columns::{set, unobserved};
use super::probe::Probe;
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
        name: "ground_joint_height",
        unit: "m",
        group: "Ground",
        meaning: "the same where the radar's own scans around that saw it again together place what stands still",
    },
    Feature {
        name: "ground_joint_height_sigmas",
        unit: "sigma",
        group: "Ground",
        meaning: "that height, in its own standard deviations",
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
    let heights = |probe: &Probe| {
        let height = ground.height(&probe.detection.position).filter(|_| measured);
        let sigma = probe.detection.sigma_along(&Vector::z()).hypot(SURFACE_SIGMA);
        [height, height.map(|height| height / sigma)]
    };
    for (i, (probe, joint)) in surroundings.probes().iter().zip(surroundings.joint_probes()).enumerate() {
        let (Some(probe), Some(joint)) = (probe, joint) else { continue };
        let ([height, sigmas], [joint_height, joint_sigmas]) = (heights(probe), heights(joint));
        let p = probe.detection.position;
        let (step, unseen) = (ground.step_at(p.x, p.y), ground.unseen_at(p.x, p.y));
        set(&mut columns, i, [height, sigmas, joint_height, joint_sigmas, step, unseen]);
    }
    columns
}
