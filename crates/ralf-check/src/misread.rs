//! LiDAR scans that show no road: read as something else, they may show one.

use crate::ground::{self, GroundFit, OFFSET, SUPPORT, TILT_DEG};
use crate::thinning::{returns, some};
use ralf::sensors::LidarScan;
use ralf::space::{Point, Transform};
use std::collections::HashSet;

/// What a scan was taken for by mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Misread {
    /// Its points lie in the vehicle's frame already.
    InVehicleFrame,
    /// Its rows have so many numbers, and not four.
    Columns(usize),
}

/// Numbers of a row that are tried.
const COLUMNS: [usize; 3] = [3, 5, 6];
/// A LiDAR that is mounted nearer to the vehicle's origin has nearly the vehicle's frame, m.
const MOUNTED: f64 = 0.5;
/// Points that are looked at.
const POINTS: usize = 20_000;
/// On a road points of one direction lie at so many distances, in whole metres, in half of the directions at least:
/// what stands upright has one.
const DISTANCES: usize = 4;
/// Directions, and how near, m.
const DIRECTIONS: (f64, f64) = (36.0, 25.0);

/// By which reading a scan would show a road at z = 0 of the vehicle.
pub(crate) fn misread(read: &LidarScan, mount: &Transform) -> Vec<Misread> {
    let in_vehicle = Some(Misread::InVehicleFrame).filter(|_| mount.translation.vector.norm() > MOUNTED);
    let all = in_vehicle.into_iter().chain(COLUMNS.map(Misread::Columns));
    all.filter(|as_what| shows_road(&as_what.points(read, mount), mount)).collect()
}

impl Misread {
    /// Points in the vehicle frame, m, by this reading.
    fn points(self, read: &LidarScan, mount: &Transform) -> Vec<Point> {
        let point = |[x, y, z]: &[f32; 3]| Point::new((*x).into(), (*y).into(), (*z).into());
        match self {
            Self::InVehicleFrame => some(&returns(read.points.iter().copied()), POINTS).map(point).collect(),
            Self::Columns(columns) => {
                let rows = read.points.iter().zip(&read.intensity);
                let numbers: Vec<f32> = rows.flat_map(|([x, y, z], last)| [*x, *y, *z, *last]).collect();
                let rows = numbers.chunks_exact(columns).map(|row| [row[0], row[1], row[2]]);
                some(&returns(rows), POINTS).map(|p| mount * point(p)).collect()
            }
        }
    }
}

fn shows_road(points: &[Point], mount: &Transform) -> bool {
    let level = |fit: &GroundFit| {
        fit.offset.abs() < OFFSET
            && fit.slope.iter().all(|slope| slope.to_degrees().abs() < TILT_DEG)
            && fit.support > SUPPORT
    };
    let found = ground::fit(points, &mount.translation.vector.into());
    found.filter(level).is_some_and(|fit| lies_flat(points, &fit))
}

/// Whether what lies on the plane is seen at many distances, one behind the other.
fn lies_flat(points: &[Point], fit: &GroundFit) -> bool {
    let near = points.iter().filter(|p| p.coords.xy().norm() < DIRECTIONS.1 && fit.is_on(p));
    let cell = |p: &Point| {
        let direction = p.y.atan2(p.x) / std::f64::consts::TAU * DIRECTIONS.0;
        (direction.floor() as i32, p.coords.xy().norm() as i32)
    };
    let cells: HashSet<(i32, i32)> = near.map(cell).collect();
    let directions: HashSet<i32> = cells.iter().map(|(direction, _)| *direction).collect();
    let in_depth = |direction: &&i32| cells.iter().filter(|cell| cell.0 == **direction).count() >= DISTANCES;
    2 * directions.iter().filter(in_depth).count() >= directions.len().max(1)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A road below a LiDAR 1.8 m above it, and a wall to the left, in the LiDAR's frame.
    fn street() -> Vec<[f32; 3]> {
        let road = (0..1600).map(|i| [(i % 40) as f32 * 0.9 - 18.0, (i / 40) as f32 * 0.9 - 18.0, -1.8]);
        let wall = (0..400).map(|i| [(i % 40) as f32 - 20.0, 6.0, (i / 40) as f32 * 0.2 - 1.0]);
        road.chain(wall).collect()
    }

    fn scan(points: Vec<[f32; 3]>) -> LidarScan {
        let intensity = vec![0.5; points.len()];
        LidarScan { points, intensity, ..LidarScan::default() }
    }

    #[test]
    fn points_in_the_vehicles_frame_and_rows_of_five_numbers_are_told() {
        let mount = Transform::translation(1.2, 0.0, 1.8);
        let in_vehicle: Vec<[f32; 3]> = street().iter().map(|[x, y, z]| [x + 1.2, *y, z + 1.8]).collect();
        assert_eq!(misread(&scan(in_vehicle), &mount), [Misread::InVehicleFrame]);

        let five =
            street().into_iter().enumerate().flat_map(|(i, [x, y, z])| [x, y, z, 0.5, (i % 32) as f32]);
        let numbers: Vec<f32> = five.collect();
        let rows = numbers.chunks_exact(4);
        let misread_rows = LidarScan {
            points: rows.clone().map(|row| [row[0], row[1], row[2]]).collect(),
            intensity: rows.map(|row| row[3]).collect(),
            ..LidarScan::default()
        };
        assert_eq!(misread(&misread_rows, &mount), [Misread::Columns(5)]);
    }

    #[test]
    fn what_four_level_beams_see_of_walls_is_no_road() {
        let mount = Transform::translation(3.5, 0.0, 0.5);
        // Beams of 0.8 degrees up and down meet a wall five metres away all around, and one nearer.
        let around = (0..720).map(|i| {
            let (sin, cos) = (f64::from(i / 4) * 2.0_f64.to_radians()).sin_cos();
            let distance = if (i / 180) % 2 == 0 { 5.0 } else { 7.0 };
            let height = distance * (f64::from(i % 4) * 0.0093 - 0.014);
            [(distance * cos) as f32, (distance * sin) as f32, height as f32]
        });
        assert_eq!(misread(&scan(around.collect()), &mount), []);
    }
}
