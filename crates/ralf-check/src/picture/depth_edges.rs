//! Where things end before what lies behind them, as a LiDAR sees it.

use ralf::space::{Point, Transform};
use std::f64::consts::{FRAC_PI_4, TAU};

/// Width of a cell of the LiDAR's view, rad.
const CELL: f64 = 0.4 * std::f64::consts::PI / 180.0;
/// Cells about the LiDAR, and from 45 degrees below to 45 above it.
const COLUMNS: usize = 900;
const ROWS: usize = 225;
/// What lies behind is farther by so many m and by this share.
const BEHIND: (f64, f64) = (1.0, 0.1);
/// A neighbour is sought within so many cells.
const REACH: i64 = 3;
/// Distances of edges that an image shows sharp and a LiDAR dense, m.
const RANGES: std::ops::Range<f64> = 3.0..45.0;

/// A point at which a thing ends.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DepthEdge {
    /// Vehicle frame as recorded, m.
    pub(crate) place: Point,
    /// Whether it ends upwards; else to a side.
    pub(crate) is_top: bool,
}

/// Edges among the points of a LiDAR (vehicle frame, m) mounted at a pose; `stands` tells what is no road.
pub(crate) fn depth_edges(
    points: &[Point],
    mount: &Transform,
    stands: impl Fn(&Point) -> bool,
) -> Vec<DepthEdge> {
    let lidar_from_vehicle = mount.inverse();
    let mut nearest: Vec<Option<(f64, Point)>> = vec![None; COLUMNS * ROWS];
    for point in points {
        let own = lidar_from_vehicle * point;
        let range = own.coords.norm();
        if let Some(cell) = cell(&own) {
            let slot = &mut nearest[cell];
            if slot.is_none_or(|(known, _)| range < known) {
                *slot = Some((range, *point));
            }
        }
    }
    let mut edges = Vec::new();
    for (cell, slot) in nearest.iter().enumerate() {
        let Some((range, place)) = slot.filter(|(range, place)| RANGES.contains(range) && stands(place))
        else {
            continue;
        };
        let far = |towards: [i64; 2]| is_farther(&nearest, cell, range, towards);
        if far([1, 0]) || far([-1, 0]) {
            edges.push(DepthEdge { place, is_top: false });
        } else if far([0, 1]) {
            edges.push(DepthEdge { place, is_top: true });
        }
    }
    edges
}

fn cell(own: &Point) -> Option<usize> {
    let azimuth = own.y.atan2(own.x).rem_euclid(TAU);
    let elevation = own.z.atan2(own.x.hypot(own.y)) + FRAC_PI_4;
    let (column, row) = ((azimuth / CELL) as usize % COLUMNS, elevation / CELL);
    (row >= 0.0 && row < ROWS as f64).then(|| row as usize * COLUMNS + column)
}

/// Whether the next point towards a side lies behind.
fn is_farther(nearest: &[Option<(f64, Point)>], cell: usize, range: f64, towards: [i64; 2]) -> bool {
    let (column, row) = ((cell % COLUMNS) as i64, (cell / COLUMNS) as i64);
    for step in 1..=REACH {
        let row = row + step * towards[1];
        let column = (column + step * towards[0]).rem_euclid(COLUMNS as i64);
        if !(0..ROWS as i64).contains(&row) {
            return false;
        }
        if let Some((other, _)) = nearest[row as usize * COLUMNS + column as usize] {
            return other - range > BEHIND.0.max(BEHIND.1 * range);
        }
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_post_before_a_wall_ends_at_its_sides_and_the_wall_does_not() {
        let row = |x: f64, half: f64| {
            let count = (half / x / CELL) as i64;
            (-count..=count).map(move |i| Point::new(x, x * (i as f64 * CELL).tan(), 0.0))
        };
        let points: Vec<Point> = row(20.0, 10.0).chain(row(10.0, 0.5)).collect();
        let found = depth_edges(&points, &Transform::identity(), |_| true);
        assert!(
            found.len() >= 2 && found.iter().all(|edge| edge.place.x == 10.0 && !edge.is_top),
            "{found:?}"
        );
        assert!(depth_edges(&[], &Transform::identity(), |_| true).is_empty());
    }
}
