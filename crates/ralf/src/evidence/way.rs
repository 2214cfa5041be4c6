//! What stands in the radar's way to a detection: a march through the columns of what stands still.

use super::Probe;
use crate::scene::{Column, ColumnGrid, Frame, StaticMap};
use crate::space::{Point, Vector};

/// Length of a step, m.
const STEP: f64 = 0.2;
/// A column with something at these heights is a surface that a radar at a vehicle's height meets, m.
const SURFACE: [f64; 2] = [0.25, 1.8];
/// A column that reaches so high and has so many voxels is tall: a wall, a hedge, a lorry, m.
pub(super) const TALL: f64 = 1.0;
const TALL_VOXELS: u32 = 3;
/// The march begins so far from the radar: what is nearer belongs to the own vehicle, m.
const OWN: f64 = 1.0;

/// The ways from the radar to each detection; `None` for those without a position and beyond the map. No entry at all
/// without a window of LiDAR scans.
/// `rows` are those with a position.
pub(super) fn ways(
    frame: &Frame,
    probes: &[Option<Probe>],
    rows: impl Iterator<Item = usize>,
) -> Vec<Option<Way>> {
    let Some(lidar) = &frame.lidar_window else { return Vec::new() };
    let map = lidar.window.map();
    let radar = lidar.to_window(&Point::from(frame.radar.vehicle_from_radar.translation.vector));
    let mut ways = vec![None; probes.len()];
    for row in rows {
        let detection = probes[row].map(|probe| probe.detection);
        let on_map = detection.filter(|known| ColumnGrid::covers(known.position.x, known.position.y));
        ways[row] = on_map.map(|detection| {
            let direction = (radar - detection.position).try_normalize(1e-6).unwrap_or_else(Vector::x);
            let slack = 2.0 * detection.sigma_along(&direction);
            Way::march(map, &radar, &detection.position, slack)
        });
    }
    ways
}

/// What was met on the way from the radar to a detection.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Way {
    /// From the first surface to the detection, m.
    pub(super) behind_surface: f64,
    pub(super) surface_height: Option<f64>,
    /// From the first tall column to the detection, m; 0 where there is none.
    pub(super) behind_first_tall: f64,
    pub(super) behind_last_tall: f64,
    /// Where the last tall column was met, m.
    pub(super) last_tall: Option<[f64; 2]>,
    /// Steps through tall columns, m.
    pub(super) through: f64,
}

impl Way {
    /// Steps from the radar to the detection, seen from above; what is met within `slack` before the detection, m, may
    /// be what was detected and doesn't count.
    fn march(map: &StaticMap, radar: &Point, p: &Point, slack: f64) -> Self {
        let along = (p - radar).xy();
        let length = along.norm();
        let end = length - slack.max(STEP);
        let mut way = Self::default();
        let steps = ((end - OWN) / STEP).max(0.0) as usize;
        // Of a way of no length there is no step, so that this is a number where it is asked for.
        let lengths = [along.x, along.y].map(|component| length / component);
        let mut step = 0;
        while step < steps {
            let gone = OWN + step as f64 * STEP;
            let place = radar.coords.xy() + along * (gone / length);
            let (column, free) = map.columns.at(place.x, place.y, lengths);
            if let Some(column) = column {
                way.meet(&column, length - gone, place.into());
            }
            // Steps through nothing, a hair fewer so that rounding never decides.
            step += 1 + (0.99 / STEP * free) as usize;
        }
        way
    }

    /// A column so far before the detection, m, that was met at a place.
    fn meet(&mut self, column: &Column, before: f64, place: [f64; 2]) {
        if column.bottom <= SURFACE[1] && column.top >= SURFACE[0] && self.surface_height.is_none() {
            self.behind_surface = before;
            self.surface_height = Some(column.top);
        }
        if column.top >= TALL && column.voxels >= TALL_VOXELS && column.bottom <= SURFACE[1] {
            if self.through == 0.0 {
                self.behind_first_tall = before;
            }
            self.behind_last_tall = before;
            self.last_tall = Some(place);
            self.through += STEP;
        }
    }
}
