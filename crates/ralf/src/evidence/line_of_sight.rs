//! What stands between the radar and a detection: a march through the columns of what stands still, from the radar to
//! the detection.

use super::columns::{set, unobserved};
use super::wall::Wall;
use super::way::TALL;
use super::{Feature, Piece, Surroundings, Values};
use crate::scene::{ColumnGrid, StaticMap};
use crate::space::Point;

const GROUP: &str = "Line of sight";
/// What reaches so high is no car any more, m.
const OVER_CARS: f64 = 2.2;
/// Columns this near to a detection are its footprint, m.
const FOOTPRINT: f64 = 1.5;

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
        name: "sight_wall_length",
        unit: "m",
        group: GROUP,
        meaning: "length of the straight wall that the last thing over a metre high in the radar's way belongs to, at \
                  most 3 m to each side; null where nothing is",
    },
    Feature { name: "sight_wall_top", unit: "m", group: GROUP, meaning: "height of that wall" },
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
    for (i, _) in surroundings.rows_by_place() {
        let (Some(probe), Some(way)) = (surroundings.probes()[i], surroundings.ways()[i]) else { continue };
        let (cars, tall) = footprint(map, &probe.detection.position);
        let wall = way.last_tall.and_then(|place| Wall::at(map, place));
        let values = [
            Some(way.behind_surface),
            way.surface_height,
            Some(way.behind_first_tall),
            Some(way.behind_last_tall),
            Some(way.through),
            wall.map(|wall| wall.length),
            wall.map(|wall| wall.top),
            Some(cars),
            Some(tall),
        ];
        set(&mut columns, i, values);
    }
    columns
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
