//! What stands between the radar and a detection: a march through the columns of what stands still, from the radar to
//! the detection.

use super::columns::{set, unobserved};
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{Column, ColumnGrid, StaticMap};
use crate::space::{Point, Vector};

const GROUP: &str = "Line of sight";
/// Length of a step, m.
const STEP: f64 = 0.2;
/// A column with something at these heights is a surface that a radar at a vehicle's height meets, m.
const SURFACE: [f64; 2] = [0.25, 1.8];
/// A column that reaches so high and has so many voxels is tall: a wall, a hedge, a lorry, m.
pub(super) const TALL: f64 = 1.0;
const TALL_VOXELS: u32 = 3;
/// What reaches so high is no car any more, m.
const OVER_CARS: f64 = 2.2;
/// Columns this near to a detection are its footprint, m.
const FOOTPRINT: f64 = 1.5;
/// The march begins so far from the radar: what is nearer belongs to the own vehicle, m.
const OWN: f64 = 1.0;

pub(super) const PIECE: Piece = Piece { features: FEATURES, observe };

const FEATURES: &[Feature] = &[
    Feature {
        name: "sight_behind_surface",
        unit: "m",
        group: GROUP,
        meaning: "how far the detection lies behind the first thing that stands in the radar's way to it, 0.25 to 1.8 \
                  m high; 0 where nothing does",
    },
    Feature {
        name: "sight_surface_height",
        unit: "m",
        group: GROUP,
        meaning: "height of the first thing that stands in the radar's way to the detection",
    },
    Feature {
        name: "sight_behind_first_tall",
        unit: "m",
        group: GROUP,
        meaning: "how far the detection lies behind the first thing over a metre high in the radar's way to it; 0 \
                  where nothing is",
    },
    Feature {
        name: "sight_behind_last_tall",
        unit: "m",
        group: GROUP,
        meaning: "how far the detection lies behind the last thing over a metre high in the radar's way to it; 0 \
                  where nothing is",
    },
    Feature {
        name: "sight_through",
        unit: "m",
        group: GROUP,
        meaning: "length of the radar's way to the detection that leads through things over a metre high",
    },
    Feature {
        name: "sight_footprint_cars",
        unit: "1",
        group: GROUP,
        meaning: "share of the columns within 1.5 m that are as high as cars, 1 to 2.2 m",
    },
    Feature {
        name: "sight_footprint_tall",
        unit: "1",
        group: GROUP,
        meaning: "share of the columns within 1.5 m that are higher than cars",
    },
];

fn observe(surroundings: &Surroundings) -> Vec<Values> {
    let frame = surroundings.frame;
    let mut columns = unobserved(FEATURES, frame.scan.len());
    let Some(lidar) = &frame.lidar_window else { return columns };
    let map = lidar.window.map();
    let radar = lidar.to_window(&Point::from(frame.radar.vehicle_from_radar.translation.vector));
    for (i, probe) in surroundings.probes().iter().enumerate() {
        let Some(probe) = probe else { continue };
        let p = probe.detection.position;
        if !ColumnGrid::covers(p.x, p.y) {
            continue;
        }
        let direction = (radar - p).try_normalize(1e-6).unwrap_or_else(Vector::x);
        let slack = 2.0 * probe.detection.sigma_along(&direction);
        let way = Way::march(map, &radar, &p, slack);
        let (cars, tall) = footprint(map, &p);
        let values = [
            Some(way.behind_surface),
            way.surface_height,
            Some(way.behind_first_tall),
            Some(way.behind_last_tall),
            Some(way.through),
            Some(cars),
            Some(tall),
        ];
        set(&mut columns, i, values);
    }
    columns
}

/// What was met on the way from the radar to a detection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Way {
    /// From the first surface to the detection, m.
    behind_surface: f64,
    surface_height: Option<f64>,
    /// From the first tall column to the detection, m; 0 where there is none.
    pub(super) behind_first_tall: f64,
    behind_last_tall: f64,
    /// Steps through tall columns, m.
    through: f64,
}

impl Way {
    /// Steps from the radar to the detection, seen from above; what is met within `slack` before the detection, m, may
    /// be what was detected and doesn't count.
    pub(super) fn march(map: &StaticMap, radar: &Point, p: &Point, slack: f64) -> Self {
        let along = (p - radar).xy();
        let length = along.norm();
        let end = length - slack.max(STEP);
        let mut way = Self::default();
        let steps = ((end - OWN) / STEP).max(0.0) as usize;
        for step in 0..steps {
            let gone = OWN + step as f64 * STEP;
            let place = radar.coords.xy() + along * (gone / length);
            if let Some(column) = map.columns.at(place.x, place.y) {
                way.meet(&column, length - gone);
            }
        }
        way
    }

    /// A column so far before the detection, m.
    fn meet(&mut self, column: &Column, before: f64) {
        if column.bottom <= SURFACE[1] && column.top >= SURFACE[0] && self.surface_height.is_none() {
            self.behind_surface = before;
            self.surface_height = Some(column.top);
        }
        if column.top >= TALL && column.voxels >= TALL_VOXELS && column.bottom <= SURFACE[1] {
            if self.through == 0.0 {
                self.behind_first_tall = before;
            }
            self.behind_last_tall = before;
            self.through += STEP;
        }
    }
}

/// The shares of the columns around that are as high as cars, and higher.
fn footprint(map: &StaticMap, p: &Point) -> (f64, f64) {
    let (mut cars, mut tall) = (0, 0);
    for (_, column) in map.columns.around(p.x, p.y, FOOTPRINT) {
        cars += u32::from((TALL..OVER_CARS).contains(&column.top));
        tall += u32::from(column.top >= OVER_CARS);
    }
    let all = (2.0 * FOOTPRINT / ColumnGrid::CELL).powi(2);
    (f64::from(cars) / all, f64::from(tall) / all)
}
