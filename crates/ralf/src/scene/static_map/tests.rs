use super::*;
use crate::config::GroundConfig;
use crate::scene::LidarSnapshot;
use crate::sensors::{Lidar, LidarScan};
use crate::space::Transform;
use std::f64::consts::FRAC_PI_4;
use std::sync::Arc;

/// Scans of a LiDAR 2 m above the origin, which stands still.
fn views(scans: Vec<Vec<[f32; 3]>>) -> Vec<LidarView> {
    let lidar = Lidar {
        name: "lidar".into(),
        vehicle_from_lidar: Transform::translation(0.0, 0.0, 2.0),
        sigma_range: 0.03,
        lowest_beam: 0.4,
        max_range: None,
    };
    let view = |points: Vec<[f32; 3]>| {
        let points = points.into_iter().map(|[x, y, z]| [x, y, z - 2.0]).collect();
        let scan = Arc::new(LidarScan { points, ..Default::default() });
        let scans = vec![(&lidar, scan, Transform::identity())];
        let moment = Arc::new(LidarSnapshot::new(0, scans, &GroundConfig::default(), 0));
        LidarView { moment, vehicle_from_moment: Transform::identity() }
    };
    scans.into_iter().map(view).collect()
}

/// A road, a wall across it 20 m ahead, and a box 1 m wide and 1.4 m high whose back is at `x`, which hides them.
fn scene(x: Option<f32>) -> Vec<[f32; 3]> {
    let mut points = Vec::new();
    let mut add = |point: [f32; 3]| {
        // The box ends rays that would pass through its back.
        let meets = x.filter(|x| point[0] > *x).map(|x| {
            let share = x / point[0];
            [x, share * point[1], 2.0 + share * (point[2] - 2.0)]
        });
        match meets.filter(|[_, y, z]| y.abs() < 0.5 && (0.0..1.4).contains(z)) {
            Some(hidden) => points.push(hidden),
            None => points.push(point),
        }
    };
    (0..100).for_each(|i| (-50..50).for_each(|j| add([i as f32 * 0.2, j as f32 * 0.1, 0.0])));
    (-50..50).for_each(|j| (0..60).for_each(|k| add([20.0, j as f32 * 0.1, k as f32 * 0.05])));
    points
}

#[test]
fn what_stands_still_is_kept_and_what_moved_is_not() {
    let passing = views((0..6).map(|k| scene(Some(8.0 + 1.5 * k as f32))).collect());
    let parked = views((0..6).map(|_| scene(Some(11.0))).collect());
    let ground = GroundSurface::fit(&[
        [0.0; 3],
        [5.0, 0.0, 0.0],
        [10.0, 0.0, 0.0],
        [15.0, 0.0, 0.0],
        [20.0, 0.0, 0.0],
    ]);
    let column = |views: &[LidarView], x: f64| {
        StaticMap::new(0, views, ground.as_ref()).columns.at(x, 0.1, [1.0, f64::INFINITY]).0
    };
    let wall = column(&passing, 20.1).unwrap();
    // To a voxel; the box hides the wall's foot in every scan.
    assert!((wall.top - 2.95).abs() < 0.15 && wall.bottom < 0.7 && wall.voxels >= 12, "{wall:?}");
    // Of the last places of a box that drives away nobody sees what was there before.
    for k in 0..4 {
        assert_eq!(column(&passing, 8.05 + 1.5 * f64::from(k)), None, "the box was at {k} for a moment");
    }
    let parked = column(&parked, 11.05).unwrap();
    assert!(parked.top > 1.0 && parked.top < 1.4, "{parked:?}");
    assert_eq!(column(&passing, 5.0), None, "the road is no obstacle");
    // A scan alone can't tell.
    assert!(column(&views(vec![scene(Some(8.0))]), 8.05).is_some());
}

/// Scans with very many points aren't all taken, but the one of the map's own time is: nearer, it sees more.
#[test]
fn of_dense_scans_that_of_the_maps_time_is_taken() {
    let many =
        |x: f32| (0..100_000).map(|i| [x, (i % 300) as f32 * 0.1, 1.0 + (i / 300) as f32 * 0.01]).collect();
    let mut views = views((0..5).map(|k| many(5.0 + k as f32)).collect());
    for (k, view) in views.iter_mut().enumerate() {
        let moment = Arc::get_mut(&mut view.moment).unwrap();
        moment.t_ns = 200_000_000 * k as i64;
    }
    for (t_ns, x) in [(0, 5.0), (400_000_000, 7.0), (800_000_000, 9.0)] {
        let map = StaticMap::new(t_ns, &views, None);
        assert!(map.points.iter().any(|point| point[0] == x), "{t_ns}");
    }
}

#[test]
fn a_voxel_has_one_point() {
    let mut voxels = Voxels::new();
    for (x, height) in [
        (1.0, 0.5),
        (1.01, 0.51),
        (1.0, 0.7),
        (1.2, 0.5),
        (1.0, 0.1),
        (1.0, 9.0),
        (99.0, 1.0),
        (f32::NAN, 1.0),
    ] {
        voxels.add([x, 0.0, height], height);
    }
    assert_eq!(voxels.points, [[1.0, 0.0, 0.5], [1.0, 0.0, 0.7], [1.2, 0.0, 0.5]]);
}

#[test]
fn columns_around_a_place_are_all_that_are_near() {
    let mut grid = ColumnGrid::empty();
    let places: Vec<[f32; 2]> =
        (0..200).map(|i| [((i * 37) % 83) as f32 * 0.3 - 80.0, ((i * 53) % 97) as f32 * 0.2 - 5.0]).collect();
    for [x, y] in &places {
        grid.add(columns::GRID.at(*x, *y).unwrap(), 5);
    }
    let filled = grid.around(0.0, 0.0, 200.0).count();
    assert!(filled > 100);
    for (x, y) in [(-78.0, 0.0), (-70.3, 4.4), (-79.9, 20.0), (0.0, 0.0), (79.9, 79.9)] {
        let near = grid.around(x, y, 3.0).map(|([dx, dy], _)| [x + dx, y + dy]);
        let mut near: Vec<_> = near.collect();
        assert!(near.iter().all(|[a, b]| (a - x).abs() <= 3.0 && (b - y).abs() <= 3.0));
        let mut expected: Vec<_> = grid.around(0.0, 0.0, 200.0).map(|(place, _)| place).collect();
        expected.retain(|[a, b]| (a - x).abs() < 3.0 && (b - y).abs() < 3.0);
        near.sort_by(|a, b| a.partial_cmp(b).unwrap());
        expected.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert_eq!(near.len(), expected.len());
    }
}

#[test]
fn a_way_goes_through_nothing_as_far_as_is_told() {
    let mut grid = ColumnGrid::empty();
    assert_eq!(grid.at(0.0, 0.0, [1.0, f64::INFINITY]).1, 0.0, "nothing is known before the end");
    for i in 0..60 {
        let (x, y) = (((i * 37) % 83) as f32 * 0.9 - 40.0, ((i * 53) % 97) as f32 * 0.8 - 35.0);
        grid.add(columns::GRID.at(x, y).unwrap(), 5);
    }
    grid.finish();
    let filled: Vec<[f64; 2]> = grid.around(0.0, 0.0, 200.0).map(|(place, _)| place).collect();
    for i in 0..4000 {
        let (x, y) = (f64::from(i % 160) - 79.87, f64::from(i * 7 % 1600) * 0.1 - 79.93);
        // A column reaches half its edge beyond its middle.
        let away = |[a, b]: &[f64; 2]| (a - x).abs().max((b - y).abs()) - 0.5 * ColumnGrid::CELL;
        let nearest = filled.iter().map(away).fold(f64::INFINITY, f64::min).max(0.0);
        let angle = f64::from(i % 8) * FRAC_PI_4 + f64::from(i / 8 % 3);
        let [along_x, along_y] = if i % 5 == 0 { [0.0, -1.0] } else { [angle.cos(), angle.sin()] };
        let at =
            |gone: f64| grid.at(x + gone * along_x, y + gone * along_y, [along_x.recip(), along_y.recip()]);
        let free = at(0.0).1;
        // What is known to a block on either side is off by two metres at most.
        assert!(free > nearest - 2.3, "{x} {y}: {free} {nearest}");
        let steps = (free.min(200.0) / 0.05) as usize;
        assert!((0..steps).all(|step| at(0.05 * step as f64).0.is_none()), "{x} {y}: {free}");
    }
    assert_eq!(grid.at(90.0, 0.0, [1.0, f64::INFINITY]).1, 0.0);
}
