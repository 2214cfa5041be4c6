//! What moved while the scans of a map were made: other scans look through where it was.

use super::super::lidar::LidarView;
use super::super::rays::{Directions, RayTable};
use super::columns;
use nalgebra::{Isometry3, Point3};
use std::collections::BTreeSet;

/// Scans that are asked whether they look through a column: spread over the window.
const WITNESSES: usize = 6;
/// So many of them must.
const AGREEING: usize = 2;
/// A ray looks through a place if it ends so much farther away: m, and besides a share of the distance.
const BEYOND: f32 = 0.5;
const BEYOND_SHARE: f32 = 0.02;

/// The columns whose lowest point at least two scans of the window look through, or the only other one; ascending.
/// `cells` gives each point's column.
pub(super) fn moved_columns(points: &[[f32; 3]], cells: &[u32], views: &[LidarView]) -> Vec<u32> {
    let (columns, lowest) = lowest_points(points, cells);
    let mut through = vec![0; lowest.len()];
    for witness in witnesses(views) {
        for (count, looks) in through.iter_mut().zip(witness.looks_through(&lowest)) {
            *count += usize::from(looks);
        }
    }
    let enough = AGREEING.min(views.len().saturating_sub(1)).max(1);
    let moved = columns.into_iter().zip(through).filter(|(_, through)| *through >= enough);
    let mut moved: Vec<u32> = moved.map(|(column, _)| column).collect();
    moved.sort_unstable();
    moved
}

/// The columns that have points, and the lowest one of each.
fn lowest_points(points: &[[f32; 3]], cells: &[u32]) -> (Vec<u32>, Vec<Point3<f32>>) {
    let mut places = vec![0u32; columns::GRID.count()];
    let (mut found, mut lowest): (Vec<u32>, Vec<Point3<f32>>) = (Vec::new(), Vec::new());
    for (point, &cell) in points.iter().zip(cells) {
        let place = &mut places[cell as usize];
        if *place == 0 {
            found.push(cell);
            lowest.push(Point3::from(*point));
            *place = lowest.len() as u32;
        }
        let known = &mut lowest[*place as usize - 1];
        if point[2] < known.z {
            *known = Point3::from(*point);
        }
    }
    (found, lowest)
}

/// The LiDARs of one scan.
struct Witness<'a> {
    lidars: Vec<(Isometry3<f32>, &'a RayTable)>,
}

fn witnesses(views: &[LidarView]) -> Vec<Witness<'_>> {
    let Some(last) = views.len().checked_sub(1) else { return Vec::new() };
    let chosen: BTreeSet<usize> = (0..WITNESSES).map(|i| (last * i + 1) / (WITNESSES - 1)).collect();
    let chosen = chosen.into_iter().map(|place| &views[place.min(last)]);
    chosen
        .map(|view| {
            let lidars = view.moment.sweeps().iter().map(|sweep| {
                let map_from_lidar = view.vehicle_from_moment * sweep.moment_from_lidar;
                (map_from_lidar.inverse().cast(), sweep.rays())
            });
            Witness { lidars: lidars.collect() }
        })
        .collect()
}

impl Witness<'_> {
    /// Of each point, whether all rays of one of the LiDARs in its direction end beyond it.
    fn looks_through(&self, points: &[Point3<f32>]) -> Vec<bool> {
        let mut all = vec![false; points.len()];
        for (lidar_from_map, rays) in &self.lidars {
            let moved: Vec<[f32; 3]> = points.iter().map(|point| (lidar_from_map * point).into()).collect();
            let directions = Directions::of(&moved);
            for (place, looks) in all.iter_mut().enumerate() {
                let (azimuth, elevation, range) = directions.at(place);
                let there = rays.bin(azimuth, elevation);
                let far = range * (1.0 + BEYOND_SHARE) + BEYOND;
                *looks |= !there.is_empty() && there.iter().all(|ray| ray.range > far);
            }
        }
        all
    }
}
