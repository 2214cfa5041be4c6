//! How far a detection lies from what stands still around it: the LiDAR scans of the seconds around put together,
//! without the ground and what moved.

use super::columns::{set, unobserved};
use super::probe::{Probe, SAME_SPOT};
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{Column, ColumnGrid, StaticMap};
use crate::space::Neighbor;
use nalgebra::Vector3;

const GROUP: &str = "LiDAR map";
/// No Mahalanobis distance is larger.
const LARGEST_CHI: f64 = 10.0;
/// Of so many points, the nearest ones, the Mahalanobis distance is taken.
const CANDIDATES: usize = 8;
/// What is farther than this is far, m: no distance is larger.
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
        meaning: "distance from the nearest point of the static map, at most 3; null beyond the map",
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
        unit: "1",
        group: GROUP,
        meaning: "share of the eight directions in which something stands within 3 m",
    },
    Feature {
        name: "map_joint_distance",
        unit: "m",
        group: GROUP,
        meaning: "distance from the nearest point of the static map where the radar's own scans around that saw it \
                  again together place what stands still, at most 3",
    },
    Feature {
        name: "map_joint_chi",
        unit: "sigma",
        group: GROUP,
        meaning: "least Mahalanobis distance of that place from the points of the static map near by, at most 10",
    },
    Feature {
        name: "map_joint_column_distance",
        unit: "m",
        group: GROUP,
        meaning: "horizontal distance of that place from the nearest column in which something stands, at most 3",
    },
    Feature {
        name: "map_joint_column_sigmas",
        unit: "sigma",
        group: GROUP,
        meaning: "the same in standard deviations along it",
    },
];

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(FEATURES, frame.scan.len());
    let Some(lidar) = &frame.lidar_window else { return columns };
    let map = lidar.window.map();
    let mut found = Vec::new();
    for (i, _) in surroundings.rows_by_place() {
        let measured = look(map, surroundings.probes()[i]);
        let mut distances = |known: &Option<(Around, Probe)>| match known {
            Some((around, probe)) => around.distances(map, probe, &mut found).map(Some),
            None => [None; 4],
        };
        let at_measured = distances(&measured);
        let at_joint = if surroundings.is_placed_jointly(i) {
            distances(&look(map, surroundings.joint_probes()[i]))
        } else {
            at_measured
        };
        let around = measured.as_ref().map(|(around, _)| around);
        let near = around.and_then(Around::near);
        let values = [
            at_measured[0],
            at_measured[1],
            at_measured[2],
            at_measured[3],
            near.map(|column| column.top),
            near.map(|column| column.bottom),
            around.map(|around| f64::from(around.voxels).ln_1p()),
            around.map(|around| f64::from(around.octants.count_ones()) / 8.0),
            at_joint[0],
            at_joint[1],
            at_joint[2],
            at_joint[3],
        ];
        set(&mut columns, i, values);
    }
    columns
}

/// What stands around a detection that lies on the map.
fn look(map: &StaticMap, probe: Option<Probe>) -> Option<(Around, Probe)> {
    let probe = probe?;
    let p = probe.detection.position;
    ColumnGrid::covers(p.x, p.y).then(|| (Around::look(map, &probe), probe))
}

/// The Euclidean distance from the nearest point, and the least Mahalanobis distance.
fn nearest_point(map: &StaticMap, probe: &Probe, found: &mut Vec<Neighbor>) -> [f64; 2] {
    let position = probe.detection.position.coords;
    map.index.nearest_within(position.cast::<f32>().into(), CANDIDATES, AROUND as f32, found);
    let nearest = found.first().map_or(AROUND, |neighbor| f64::from(neighbor.distance_squared).sqrt());
    let precision = probe.precision();
    let mut least = LARGEST_CHI * LARGEST_CHI;
    for neighbor in found.iter() {
        let h = Vector3::from(map.points[neighbor.id as usize].map(f64::from)) - position;
        least = least.min(h.dot(&(precision * h)));
    }
    [nearest.min(AROUND), least.max(0.0).sqrt()]
}

/// The columns around a detection in which something stands.
struct Around {
    /// The nearest one and the way to its middle, m.
    nearest: Option<([f64; 2], Column)>,
    /// From its middle, m.
    distance: f64,
    /// A bit for each eighth of the circle in which one is.
    octants: u8,
    /// Voxels that are filled near by.
    voxels: u32,
}

impl Around {
    fn look(map: &StaticMap, probe: &Probe) -> Self {
        let p = probe.detection.position;
        let mut around = Self { nearest: None, distance: AROUND, octants: 0, voxels: 0 };
        for ([x, y], column) in map.columns.around(p.x, p.y, AROUND) {
            let distance = (x * x + y * y).sqrt();
            if distance > AROUND {
                continue;
            }
            around.octants |= octant(x, y);
            around.voxels += if distance <= BESIDE { column.voxels } else { 0 };
            if distance < around.distance {
                around.distance = distance;
                around.nearest = Some(([x, y], column));
            }
        }
        around
    }

    /// The column that stands near, if one does.
    fn near(&self) -> Option<Column> {
        self.nearest.map(|(_, column)| column).filter(|_| self.distance <= NEAR)
    }

    /// How far a detection lies from the map: from its nearest point, m; from its points, in standard deviations; from
    /// the nearest column, m and in standard deviations. `found` is room for a search.
    fn distances(&self, map: &StaticMap, probe: &Probe, found: &mut Vec<Neighbor>) -> [f64; 4] {
        let [distance, chi] = match self.nearest {
            Some(_) => nearest_point(map, probe, found),
            None => [AROUND, LARGEST_CHI],
        };
        [distance, chi, self.distance, self.sigmas(probe)]
    }

    /// The distance in standard deviations along it.
    fn sigmas(&self, probe: &Probe) -> f64 {
        let Some(([x, y], _)) = self.nearest else { return LARGEST_CHI };
        let direction = Vector3::new(x, y, 0.0).try_normalize(1e-6).unwrap_or_else(Vector3::x);
        (self.distance / probe.detection.sigma_along(&direction).hypot(SAME_SPOT)).min(LARGEST_CHI)
    }
}

/// The bit of the eighth of the circle to which a direction belongs.
fn octant(x: f64, y: f64) -> u8 {
    1 << (u8::from(x > 0.0) + 2 * u8::from(y > 0.0) + 4 * u8::from(x.abs() > y.abs()))
}
