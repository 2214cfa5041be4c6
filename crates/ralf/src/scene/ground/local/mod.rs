//! The ground as a surface that follows slopes, ramps and kerbs: a height per cell of half a metre.
//!
//! The lowest point of each cell is taken to be ground unless its neighbours disagree: it is clipped to their median,
//! the cells between are filled from the nearest known one, and what is left standing of objects (cells that saw a
//! car's roof alone) is opened away, since nothing so narrow is ground. A road that shines shows LiDARs points below
//! it, some in a thousand: were anything left of them, opening would take the whole road down to it.

mod raster;

use super::super::cells::Cells;
use super::plane::Plane;
use crate::space::{Point, Vector};
use raster::Raster;

/// Edge of a cell, m.
const CELL: f32 = 0.5;
/// The surface reaches so far from the frame's origin in x and in y, m.
const REACH: f32 = 80.0;
const CELLS: Cells = Cells::new(REACH, CELL);
/// No ground rises or falls by more than this at the vehicle, m, and besides by so much per metre of distance.
const MAX_OFFSET: f32 = 2.0;
const MAX_SLOPE: f32 = 0.2;
/// Cells to each side whose median a cell is compared with, and how far it may be off, m.
const MEDIAN_RADIUS: usize = 2;
const MEDIAN_SLACK: f32 = 0.3;
/// Nothing narrower than this many cells and one more to each side is ground: vehicles are.
const OPENING_RADIUS: usize = 4;
/// Cells to each side that are averaged.
const SMOOTHING_RADIUS: usize = 1;
/// Ground is told only so near to a cell that was seen, m.
const KNOWN_WITHIN: f32 = 8.0;

/// A ground surface over the horizontal plane of a frame.
#[derive(Debug, Clone)]
pub struct GroundSurface {
    /// Smoothed, m.
    heights: Raster,
    /// The difference of the highest and the lowest cell around each one, before smoothing, m.
    steps: Raster,
    /// From the nearest cell that was seen, m.
    unseen: Raster,
}

impl GroundSurface {
    /// The surface below points (m, z up; those that are not finite are skipped). `None` where none can be ground.
    pub fn fit(points: &[[f32; 3]]) -> Option<Self> {
        let mut lowest = Raster::filled(CELLS.along, f32::INFINITY);
        for &point in points {
            let Some(cell) = admissible(point).and_then(|[x, y, _]| CELLS.at(x, y)) else { continue };
            lowest.values[cell] = lowest.values[cell].min(point[2]);
        }
        let known: Vec<usize> = (0..CELLS.count()).filter(|cell| lowest.values[*cell].is_finite()).collect();
        if known.is_empty() {
            return None;
        }
        let clipped = lowest.clipped_to_median(&known, MEDIAN_RADIUS, MEDIAN_SLACK);
        let (filled, cells_away) = clipped.filled_from_nearest();
        let opened = filled.eroded(OPENING_RADIUS).dilated(OPENING_RADIUS);
        let steps = opened.dilated(1).minus(&opened.eroded(1));
        Some(Self { heights: opened.smoothed(SMOOTHING_RADIUS), steps, unseen: cells_away.scaled(CELL) })
    }

    /// The lowest of the points that lie in the same cell, one for each cell that has any: a surface fitted to these is
    /// the one fitted to all.
    pub fn lowest_points(points: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let mut lowest = vec![u32::MAX; CELLS.count()];
        for (id, &point) in (0u32..).zip(points) {
            let Some(cell) = admissible(point).and_then(|[x, y, _]| CELLS.at(x, y)) else { continue };
            if lowest[cell] == u32::MAX || point[2] < points[lowest[cell] as usize][2] {
                lowest[cell] = id;
            }
        }
        lowest.into_iter().filter(|id| *id != u32::MAX).map(|id| points[id as usize]).collect()
    }

    /// The lowest of all points within about a metre, everywhere.
    pub(crate) fn lowest_within_a_metre(lowest: &[[f32; 3]]) -> Floor {
        let mut raster = Raster::filled(CELLS.along, f32::INFINITY);
        for &[x, y, z] in lowest {
            if let Some(cell) = CELLS.at(x, y) {
                raster.values[cell] = raster.values[cell].min(z);
            }
        }
        Floor { heights: raster.eroded(2) }
    }

    /// Height of the ground in the cell of a place, m; `None` far from all ground that was seen.
    pub(crate) fn cell_height(&self, x: f32, y: f32) -> Option<f32> {
        let cell = CELLS.at(x, y)?;
        (self.unseen.values[cell] <= KNOWN_WITHIN).then(|| self.heights.values[cell])
    }

    /// Height of the ground at a place, m; `None` far from all ground that was seen.
    pub fn height_at(&self, x: f64, y: f64) -> Option<f64> {
        self.is_known(x, y).then(|| self.heights.between(place(x), place(y)))
    }

    /// Height of a point above the ground, m; `None` far from all ground that was seen.
    pub fn height(&self, p: &Point) -> Option<f64> {
        Some(p.z - self.height_at(p.x, p.y)?)
    }

    /// The difference of the highest and the lowest ground within a cell of a place, m: kerbs, walls' feet, slopes.
    /// `None` far from all ground that was seen.
    pub fn step_at(&self, x: f64, y: f64) -> Option<f64> {
        let cell = CELLS.at(x as f32, y as f32)?;
        self.is_known(x, y).then(|| f64::from(self.steps.values[cell]))
    }

    /// How far a place is from the nearest cell whose ground was seen, m; `None` beyond the surface.
    pub fn unseen_at(&self, x: f64, y: f64) -> Option<f64> {
        CELLS.at(x as f32, y as f32).map(|cell| f64::from(self.unseen.values[cell]))
    }

    /// The plane that touches the ground at a place; `None` far from all ground that was seen.
    pub fn plane_at(&self, x: f64, y: f64) -> Option<Plane> {
        let h = f64::from(CELL);
        let z = self.height_at(x, y)?;
        let slope = |dx: f64, dy: f64| {
            let [ahead, back] =
                [1.0, -1.0].map(|side| self.heights.between(place(x + side * dx), place(y + side * dy)));
            (ahead - back) / (2.0 * h)
        };
        Plane::through(&Point::new(x, y, z), Vector::new(-slope(h, 0.0), -slope(0.0, h), 1.0))
    }

    fn is_known(&self, x: f64, y: f64) -> bool {
        CELLS.at(x as f32, y as f32).is_some_and(|cell| self.unseen.values[cell] <= KNOWN_WITHIN)
    }
}

/// The lowest points of a scan, spread over the cells around.
#[derive(Debug)]
pub(crate) struct Floor {
    heights: Raster,
}

impl Floor {
    /// The lowest height near a place, m; infinite where there is none, `None` beyond the border.
    pub(crate) fn at(&self, x: f32, y: f32) -> Option<f32> {
        CELLS.at(x, y).map(|cell| self.heights.values[cell])
    }
}

/// The point, if it can be ground.
fn admissible(point: [f32; 3]) -> Option<[f32; 3]> {
    let [x, y, z] = point;
    (z.abs() <= MAX_OFFSET + MAX_SLOPE * (x * x + y * y).sqrt()).then_some(point)
}

/// Where a coordinate lies, in cells from the middle of the first one.
fn place(coordinate: f64) -> f64 {
    (coordinate + f64::from(REACH)) / f64::from(CELL) - 0.5
}

#[cfg(test)]
mod tests;
