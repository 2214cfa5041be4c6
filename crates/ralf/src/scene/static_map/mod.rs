//! What stands still around the vehicle: the LiDAR scans of a window put together, without the ground and without what
//! moved meanwhile.

mod columns;
mod movers;

pub use columns::{Column, ColumnGrid};

use super::ground::GroundSurface;
use super::lidar::LidarView;
use super::standing::VOXEL;
use crate::space::NeighborIndex;
use nalgebra::{Isometry3, Point3};

/// Voxels along an edge of the map.
const VOXELS: usize = (2.0 * REACH / VOXEL) as usize;
/// The map reaches so far from the frame's origin in x and in y, m.
pub(super) const REACH: f32 = 80.0;
/// Points of all scans together from which every second scan is enough, every third from twice as many, and so on.
const ENOUGH: usize = 120_000;
/// Of what stands so high above the ground, m, the map is made.
const LOWEST: f32 = 0.2;
const HIGHEST: f32 = LOWEST + 40.0 * VOXEL;

/// Points of what stands still, a point for each voxel of 0.15 m, and the columns that they fill.
#[derive(Debug)]
pub struct StaticMap {
    /// The points, m.
    pub points: Vec<[f32; 3]>,
    /// The points in bird's-eye cells.
    pub index: NeighborIndex,
    /// The columns above the ground.
    pub columns: ColumnGrid,
}

impl StaticMap {
    /// The map of LiDAR scans in the order of time, each with the way to the map's frame, which is that of a time, ns;
    /// above a ground, without one above z = 0.
    pub fn new(t_ns: i64, views: &[LidarView], ground: Option<&GroundSurface>) -> Self {
        let standing: usize = views.iter().map(|view| view.moment.standing_points().len()).sum();
        let mut voxels = Voxels::new();
        // What stands still needs not be seen in every scan, but in that of the map's own time.
        let every = standing.div_ceil(ENOUGH).max(1);
        let nearest = views.iter().enumerate().min_by_key(|(_, view)| view.moment.t_ns.abs_diff(t_ns));
        let first = nearest.map_or(0, |(place, _)| place % every);
        for view in views.iter().skip(first).step_by(every) {
            let map_from_moment: Isometry3<f32> = view.vehicle_from_moment.cast();
            for point in view.moment.standing_points() {
                let point: [f32; 3] = (map_from_moment * Point3::from(*point)).into();
                let below = ground.and_then(|ground| ground.cell_height(point[0], point[1])).unwrap_or(0.0);
                voxels.add(point, point[2] - below);
            }
        }
        let Voxels { mut points, cells, mut columns, .. } = voxels;
        let moved = movers::moved_columns(&points, &cells, views);
        for cell in &moved {
            columns.clear(*cell as usize);
        }
        columns.finish();
        let mut cells = cells.iter();
        points.retain(|_| cells.next().is_none_or(|cell| columns.is_filled(*cell as usize)));
        let ids: Vec<u32> = (0..points.len() as u32).collect();
        Self { index: NeighborIndex::new(&points, &ids), points, columns }
    }
}

/// The first point of each voxel above the ground.
struct Voxels {
    filled: Filled,
    points: Vec<[f32; 3]>,
    /// The column of each point.
    cells: Vec<u32>,
    columns: ColumnGrid,
}

impl Voxels {
    fn new() -> Self {
        Self {
            filled: Filled::nothing(),
            points: Vec::new(),
            cells: Vec::new(),
            columns: ColumnGrid::empty(),
        }
    }

    fn add(&mut self, point: [f32; 3], height: f32) {
        let [column, row] = [point[0], point[1]].map(|v| (v + REACH) / VOXEL);
        let inside = |v: f32| (0.0..VOXELS as f32).contains(&v);
        if !(inside(column) && inside(row) && (LOWEST..HIGHEST).contains(&height)) {
            return;
        }
        let filled = self.filled.above(column as i32 as usize, row as i32 as usize);
        let level = ((height - LOWEST) / VOXEL) as i32;
        if *filled & (1 << level) != 0 {
            return;
        }
        *filled |= 1 << level;
        if let Some(cell) = columns::GRID.at(point[0], point[1]) {
            self.points.push(point);
            self.cells.push(cell as u32);
            self.columns.add(cell, level);
        }
    }
}

/// A bit for each voxel above each place. Most places have none: there is room for those near one that has.
struct Filled {
    /// Of each block of places, row by row, the number of its places, counted from 1; 0 where nothing is filled.
    blocks: Vec<u32>,
    places: Vec<[u64; BLOCK * BLOCK]>,
}

/// Places along the edge of a block.
const BLOCK: usize = 8;
/// Blocks along an edge of the map.
const BLOCKS: usize = VOXELS.div_ceil(BLOCK);

impl Filled {
    fn nothing() -> Self {
        Self { blocks: vec![0; BLOCKS * BLOCKS], places: Vec::new() }
    }

    /// The voxels above a place.
    fn above(&mut self, column: usize, row: usize) -> &mut u64 {
        let block = &mut self.blocks[row / BLOCK * BLOCKS + column / BLOCK];
        if *block == 0 {
            self.places.push([0; BLOCK * BLOCK]);
            *block = self.places.len() as u32;
        }
        &mut self.places[*block as usize - 1][row % BLOCK * BLOCK + column % BLOCK]
    }
}

#[cfg(test)]
mod tests;
