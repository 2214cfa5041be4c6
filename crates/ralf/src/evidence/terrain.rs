//! What the ground below a detection is like: grass differs from asphalt in brightness and roughness.

use super::columns::{set, unobserved};
use super::{Feature, Piece, Surroundings, Values};

const GROUP: &str = "Terrain";

pub(super) const PIECE: Piece = Piece { features: FEATURES, observe };

const FEATURES: &[Feature] = &[
    Feature {
        name: "terrain_brightness",
        unit: "1",
        group: GROUP,
        meaning: "LiDAR intensity of the ground within a metre, less the median of all ground as far away, in \
                  interquartile ranges",
    },
    Feature {
        name: "terrain_mottling",
        unit: "1",
        group: GROUP,
        meaning: "standard deviation of the ground's LiDAR intensity within a metre, in the same unit",
    },
    Feature {
        name: "terrain_roughness",
        unit: "m",
        group: GROUP,
        meaning: "standard deviation of the ground's height within patches of half a metre",
    },
];

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(FEATURES, frame.scan.len());
    let Some(lidar) = &frame.lidar_window else { return columns };
    let terrain = lidar.window.terrain();
    for (i, probe) in surroundings.probes().iter().enumerate() {
        let Some(probe) = probe else { continue };
        let p = probe.detection.position;
        let Some(texture) = terrain.at(p.x, p.y) else { continue };
        set(&mut columns, i, [Some(texture.brightness), Some(texture.mottling), texture.roughness]);
    }
    columns
}
