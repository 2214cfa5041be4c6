//! What a LiDAR saw so far, as surfaces: in every cube the mean of the points and how they spread.

use nalgebra::{Matrix3, SymmetricEigen};
use ralf::space::{Point, Vector};
use std::collections::HashMap;

/// Side of a cube, m: a wall is flat in it, and the beams of a distant LiDAR still meet in it.
const SIDE: f64 = 1.0;
/// Fewer points than this have no surface.
const FEWEST: u32 = 6;
/// More points say nothing new.
const MOST: u32 = 300;
/// A line that holds stands upright, as poles and edges of houses do: the sine of its elevation. Those that lie are
/// what a beam draws onto a road or a wall, and a ring on the road goes along with the vehicle.
const UPRIGHT: f64 = 0.8;
/// Points are flat, or in a line, when they spread across so many times less than along (variances).
const FLAT: f64 = 0.04;
const STRAIGHT: f64 = 0.1;
/// What a LiDAR's noise adds to every spread, m^2: thinner things are no flatter.
const NOISE: f64 = 0.02 * 0.02;

/// A cube's number along each axis.
type Cell = [i32; 3];

/// Points of a cube.
#[derive(Debug, Clone, Default)]
struct Voxel {
    count: u32,
    sum: Vector,
    /// Of the outer products.
    squares: Matrix3<f64>,
    /// Renewed when the voxel has grown by half.
    surface: Option<Surface>,
    next_look: u32,
}

/// What holds points.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surface {
    pub(super) mean: Point,
    /// Which directions of an offset from the mean cost: across a plane, or across a line.
    pub(super) across: Matrix3<f64>,
}

impl Surface {
    fn of(voxel: &Voxel) -> Option<Self> {
        if voxel.count < FEWEST {
            return None;
        }
        let n = f64::from(voxel.count);
        let mean = voxel.sum / n;
        let spread = voxel.squares / n - mean * mean.transpose();
        let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(spread);
        let mut order = [0, 1, 2];
        order.sort_by(|a, b| eigenvalues[*a].total_cmp(&eigenvalues[*b]));
        let [normal, along] = [order[0], order[2]].map(|axis| eigenvectors.column(axis).into_owned());
        let [least, middle, most] = order.map(|axis| eigenvalues[axis] + NOISE);
        let across = if least < FLAT * middle {
            normal * normal.transpose()
        } else if middle < STRAIGHT * most {
            if along.z.abs() < UPRIGHT {
                return None;
            }
            Matrix3::identity() - along * along.transpose()
        } else {
            // What is neither, such as two rings on the road, would hold on to itself.
            return None;
        };
        Some(Self { mean: mean.into(), across })
    }
}

/// The surfaces about the vehicle, odom frame.
#[derive(Debug, Default)]
pub(super) struct Voxels {
    voxels: HashMap<Cell, Voxel>,
}

impl Voxels {
    /// Adds points (odom frame, m).
    pub(super) fn add(&mut self, points: impl Iterator<Item = Point>) {
        for point in points {
            let voxel = self.voxels.entry(cell(&point, SIDE)).or_default();
            if voxel.count >= MOST {
                continue;
            }
            voxel.count += 1;
            voxel.sum += point.coords;
            voxel.squares += point.coords * point.coords.transpose();
            if voxel.count >= voxel.next_look.max(FEWEST) {
                voxel.surface = Surface::of(voxel);
                voxel.next_look = voxel.count + voxel.count / 2;
            }
        }
    }

    /// Forgets what lies farther from a place than this, m.
    pub(super) fn forget_beyond(&mut self, place: &Point, distance: f64) {
        self.voxels.retain(|_, voxel| (voxel.sum / f64::from(voxel.count) - place.coords).norm() < distance);
    }

    /// The surface nearest to a place, in its cube or one that shares a face with it.
    pub(super) fn nearest(&self, place: &Point) -> Option<&Surface> {
        let own = cell(place, SIDE);
        let mut best: Option<(f64, &Surface)> = None;
        for [x, y, z] in [[0, 0, 0], [1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]] {
            let cell = [own[0].saturating_add(x), own[1].saturating_add(y), own[2].saturating_add(z)];
            let Some(surface) = self.voxels.get(&cell).and_then(|voxel| voxel.surface.as_ref()) else {
                continue;
            };
            let distance = (surface.mean - place).norm_squared();
            if best.is_none_or(|(nearest, _)| distance < nearest) {
                best = Some((distance, surface));
            }
        }
        best.map(|(_, surface)| surface)
    }
}

/// One point of each cube of this side, the first of each.
pub(super) fn thinned(points: &[Point], side: f64) -> Vec<Point> {
    let mut seen = std::collections::HashSet::new();
    points.iter().filter(|point| seen.insert(cell(point, side))).copied().collect()
}

fn cell(point: &Point, side: f64) -> Cell {
    [point.x, point.y, point.z].map(|value| (value / side).floor() as i32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_holds_across_and_a_pole_all_around() {
        let mut voxels = Voxels::default();
        voxels.add((0..40).map(|i| Point::new(5.5, f64::from(i % 8) * 0.12, f64::from(i / 8) * 0.15)));
        voxels.add((0..40).map(|i| Point::new(-3.5, 0.5 + 0.01 * f64::from(i % 3), f64::from(i) * 0.02)));
        let wall = voxels.nearest(&Point::new(5.1, 0.4, 0.4)).unwrap();
        assert!((wall.across - Matrix3::from_diagonal(&Vector::x())).norm() < 1e-6, "{wall:?}");
        let pole = voxels.nearest(&Point::new(-3.2, 0.4, 0.4)).unwrap();
        assert!(
            (pole.across - Matrix3::from_diagonal(&Vector::new(1.0, 1.0, 0.0))).norm() < 0.02,
            "{pole:?}"
        );
        voxels.add((0..40).map(|i| Point::new(8.5, 0.02 * f64::from(i) + 0.1, 0.0)));
        assert!(voxels.nearest(&Point::new(8.5, 0.5, 0.1)).is_none(), "a ring on the road");
        voxels.forget_beyond(&Point::new(5.0, 0.0, 0.0), 4.0);
        assert!(voxels.nearest(&Point::new(-3.2, 0.4, 0.4)).is_none());
        assert!(voxels.nearest(&Point::new(5.1, 0.4, 0.4)).is_some());
    }

    #[test]
    fn of_each_cube_one_point_is_kept() {
        let row: Vec<Point> = (0..100).map(|i| Point::new(f64::from(i) * 0.1, 0.0, 0.0)).collect();
        assert_eq!(thinned(&row, 2.0).len(), 5);
    }
}
