//! LiDAR points in a straight view, without those that the camera cannot see (docs/method.md, section 5).

use super::grid::PixelGrid;
use crate::sensors::{StraightView, ViewPoint};
use crate::space::{Point, Transform};

/// A point hides another that is deeper than this fraction of the other's depth allows.
const NEARER: f64 = 0.9;

/// Projects points of the camera's mother frame into a view, in their order, without the occluded.
///
/// `camera_from_points` leads from the points' frame to the camera's optical frame. A point of depth `Z` is occluded
/// when another point inside the view has a depth below `0.9 Z` and lies within `window` px in both u and v, inclusive.
/// Points that aren't finite are in no view.
pub fn project_points(
    points: &[Point],
    camera_from_points: &Transform,
    view: &StraightView,
    window: f64,
) -> Vec<ViewPoint> {
    let view_from_points = view.camera_from_view.inverse() * camera_from_points;
    let matrix = view_from_points.rotation.to_rotation_matrix();
    let offset = view_from_points.translation.vector;
    let [right, down, forward] = [0, 1, 2].map(|axis| matrix.matrix().row(axis).transpose());
    let project = |p: &Point| {
        let depth = forward.dot(&p.coords) + offset.z;
        // Half of the points lie behind the view: for them the rest need not be computed.
        if depth.is_nan() || depth <= 0.0 {
            return None;
        }
        let across = [right.dot(&p.coords) + offset.x, down.dot(&p.coords) + offset.y];
        view.project_own(&Point::new(across[0], across[1], depth))
    };
    visible(points.iter().filter_map(project).collect(), window)
}

/// Those of the points in a view that no other occludes.
fn visible(seen: Vec<ViewPoint>, window: f64) -> Vec<ViewPoint> {
    let pixels: Vec<[f64; 2]> = seen.iter().map(|point| point.pixel).collect();
    let grid = PixelGrid::new(&pixels, (window / 3.001).max(1.0));
    let nearest = NearestAround::new(&seen, &grid, window);
    let occluded = |point: &ViewPoint| {
        let limit = NEARER * point.depth;
        let bucket = grid.bucket(point.pixel);
        nearest.possibly[bucket] < limit
            && (nearest.surely[bucket] < limit || nearest.is_below(limit, point.pixel, &seen, &grid, window))
    };
    seen.iter().filter(|point| !occluded(point)).copied().collect()
}

/// The least depth around each bucket: settles most points without looking at their neighbours one by one.
struct NearestAround {
    /// The least depth in the bucket itself.
    own: Vec<f64>,
    /// The least depth in the buckets that lie within the window of every pixel of the bucket.
    surely: Vec<f64>,
    /// The least depth in those that lie within the window of any.
    possibly: Vec<f64>,
}

impl NearestAround {
    fn new(seen: &[ViewPoint], grid: &PixelGrid, window: f64) -> Self {
        let least = |bucket: usize| {
            let depths = grid.places(bucket..bucket + 1).iter().map(|place| seen[place.index].depth);
            depths.fold(f64::INFINITY, f64::min)
        };
        let own: Vec<f64> = (0..grid.len()).map(least).collect();
        // Places that are n buckets apart lie more than n - 1 and less than n + 1 widths apart, but for rounding.
        let widths = window / grid.cell();
        let surely = match (widths - 1e-6) as usize {
            0 => vec![f64::INFINITY; own.len()],
            inside => least_around(&own, grid.rows(), inside - 1),
        };
        let possibly = least_around(&own, grid.rows(), (widths + 1e-6) as usize + 1);
        Self { own, surely, possibly }
    }

    /// Whether a place within the window of a pixel has a depth below the limit.
    fn is_below(
        &self,
        limit: f64,
        [u, v]: [f64; 2],
        seen: &[ViewPoint],
        grid: &PixelGrid,
        window: f64,
    ) -> bool {
        // Wide enough that rounding of the window's ends loses no bucket; the places themselves are compared exactly.
        let reach = window * (1.0 + 1e-9) + 1e-9;
        let is_hidden_by = |bucket: usize| {
            grid.places(bucket..bucket + 1).iter().any(|place| {
                let inside = (place.pixel[0] - u).abs() <= window && (place.pixel[1] - v).abs() <= window;
                inside && seen[place.index].depth < limit
            })
        };
        (grid.row(v - reach)..=grid.row(v + reach)).any(|row| {
            let mut buckets = grid.buckets(row, u - reach, u + reach);
            buckets.any(|bucket| self.own[bucket] < limit && is_hidden_by(bucket))
        })
    }
}

/// The least value within so many rows and columns of each place of a grid: along the rows first, then across.
fn least_around(values: &[f64], rows: usize, reach: usize) -> Vec<f64> {
    let columns = values.len() / rows;
    let reduce = |target: &mut [f64], source: &[f64]| {
        target
            .iter_mut()
            .zip(source)
            .for_each(|(least, value)| *least = if *value < *least { *value } else { *least });
    };
    let mut along = values.to_vec();
    for (target, row) in along.chunks_exact_mut(columns).zip(values.chunks_exact(columns)) {
        for shift in 1..=reach.min(columns - 1) {
            reduce(&mut target[shift..], &row[..columns - shift]);
            reduce(&mut target[..columns - shift], &row[shift..]);
        }
    }
    let mut around = along.clone();
    for shift in 1..=reach.min(rows - 1) {
        reduce(&mut around[shift * columns..], &along[..(rows - shift) * columns]);
        reduce(&mut around[..(rows - shift) * columns], &along[shift * columns..]);
    }
    around
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sensors::View;
    use crate::space::Vector;
    use proptest::prelude::*;

    fn brute_force(seen: &[ViewPoint], window: f64) -> Vec<ViewPoint> {
        let hides = |a: &ViewPoint, b: &ViewPoint| {
            (a.pixel[0] - b.pixel[0]).abs() <= window
                && (a.pixel[1] - b.pixel[1]).abs() <= window
                && a.depth < 0.9 * b.depth
        };
        seen.iter().filter(|b| !seen.iter().any(|a| hides(a, b))).copied().collect()
    }

    /// Places on a coarse lattice, so that distances of exactly a window, and equal places, are common.
    fn point() -> impl Strategy<Value = ViewPoint> {
        let coordinate =
            || prop_oneof![(0..60).prop_map(f64::from), (0..600).prop_map(|i| f64::from(i) * 0.1)];
        (coordinate(), coordinate(), 1..40)
            .prop_map(|(u, v, depth)| ViewPoint { pixel: [u, v], depth: f64::from(depth) })
    }

    proptest! {
        #[test]
        fn it_is_what_brute_force_gives(
            seen in prop::collection::vec(point(), 0..200),
            window in prop_oneof![Just(0.0), Just(6.0), Just(0.3), Just(100.0), 0.0..20.0],
        ) {
            prop_assert_eq!(visible(seen.clone(), window), brute_force(&seen, window));
        }
    }

    #[test]
    fn the_window_is_inclusive_and_the_depth_is_not() {
        let at = |u: f64, depth: f64| ViewPoint { pixel: [u, 0.0], depth };
        assert_eq!(visible(vec![at(0.0, 8.0), at(6.0, 10.0)], 6.0), [at(0.0, 8.0)]);
        assert_eq!(visible(vec![at(0.0, 8.0), at(6.01, 10.0)], 6.0).len(), 2);
        assert_eq!(visible(vec![at(0.0, 9.0), at(6.0, 10.0)], 6.0).len(), 2);
        // The hidden hide as well: 8 is hidden by 7 and hides 9.5, which 7 is too far from.
        assert_eq!(visible(vec![at(0.0, 7.0), at(5.0, 8.0), at(10.0, 9.5)], 6.0), [at(0.0, 7.0)]);
    }

    #[test]
    fn points_come_by_the_extrinsics_in_their_order() {
        let view =
            StraightView::from(&View { yaw: 0.0, pitch: 0.0, horizontal_fov: 1.5, width: 64, height: 48 });
        // A camera 2 m ahead and 1 m up: x to the right is -y of the vehicle, and so on.
        let vehicle_from_camera =
            crate::space::transform_from_parts([2.0, 0.0, 1.0], [-0.5, 0.5, -0.5, 0.5]).unwrap();
        let points = [
            Point::new(12.0, 0.0, 1.0),
            Point::new(f64::NAN, 0.0, 1.0),
            Point::new(-5.0, 0.0, 1.0),
            Point::from(Vector::new(12.0, 2.0, 0.0)),
        ];
        let seen = project_points(&points, &vehicle_from_camera.inverse(), &view, 1.0);
        assert_eq!(seen.len(), 2);
        assert!((seen[0].pixel[0] - 31.5).abs() < 1e-9 && (seen[0].depth - 10.0).abs() < 1e-12);
        assert!((seen[1].pixel[0] - (31.5 - 0.2 * view.focal)).abs() < 1e-9, "left is left");
        assert!((seen[1].pixel[1] - (23.5 + 0.1 * view.focal)).abs() < 1e-9, "down is down");
    }
}
