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
    /// The map of LiDAR scans, each with the way to the map's frame, above a ground; without one above z = 0.
    pub fn new(views: &[LidarView], ground: Option<&GroundSurface>) -> Self {
        let mut voxels = Voxels::new();
        for view in views {
            let map_from_moment: Isometry3<f32> = view.vehicle_from_moment.cast();
            for point in view.moment.standing_points() {
                let point: [f32; 3] = (map_from_moment * Point3::from(*point)).into();
                let [x, y, z] = point;
                let below = ground.and_then(|ground| ground.cell_height(x, y)).unwrap_or(0.0);
                voxels.add(point, z - below);
            }
        }
        let moved = movers::moved_columns(&voxels, views);
        let (mut points, mut columns) = (Vec::with_capacity(voxels.points.len()), ColumnGrid::empty());
        for (point, height) in voxels.points.into_iter().zip(voxels.heights) {
            let Some(cell) = columns::cell_of(point[0], point[1]) else { continue };
            if !moved.contains(&(cell as u32)) {
                points.push(point);
                columns.add(cell, height);
            }
        }
        let ids: Vec<u32> = (0..points.len() as u32).collect();
        Self { index: NeighborIndex::new(&points, &ids), points, columns }
    }
}

/// The first point of each voxel above the ground.
struct Voxels {
    /// A bit for each voxel above a place.
    filled: Vec<u64>,
    points: Vec<[f32; 3]>,
    /// Above the ground, m.
    heights: Vec<f32>,
}

impl Voxels {
    fn new() -> Self {
        Self { filled: vec![0; VOXELS * VOXELS], points: Vec::new(), heights: Vec::new() }
    }

    fn add(&mut self, point: [f32; 3], height: f32) {
        let [column, row] = [point[0], point[1]].map(|v| (v + REACH) / VOXEL);
        let inside = |v: f32| (0.0..VOXELS as f32).contains(&v);
        if !(inside(column) && inside(row) && (LOWEST..HIGHEST).contains(&height)) {
            return;
        }
        let filled = &mut self.filled[row as usize * VOXELS + column as usize];
        let bit = 1 << ((height - LOWEST) / VOXEL) as u32;
        if *filled & bit == 0 {
            *filled |= bit;
            self.points.push(point);
            self.heights.push(height);
        }
    }
}

#[cfg(test)]
mod tests;
