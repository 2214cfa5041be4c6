//! Distances from the static map, and what stands in the radar's way.

use super::rays::{before_wall, wall};
use super::{close, column, observe};
use crate::support::{MS, Memory, radar};
use ralf::sensors::{Elevation, Radar};

#[test]
fn before_a_wall_in_free_space_and_beyond_the_map() {
    // The wall is 18 m ahead, 3.9 m high and reaches 6 m to each side.
    let detections = vec![[17.3, 0.0, 1.5], [9.0, 0.0, 1.5], [0.0, 90.0, 1.5], [f32::NAN; 3]];
    let found = observe(&wall(Elevation::Measured, detections), 0);
    let expect = |name: &str, expected: [Option<f64>; 2], tolerance: f64| {
        let values = column(&found, name);
        for (value, expected) in values.iter().zip(expected) {
            match expected {
                Some(expected) => close(*value, expected, tolerance),
                None => assert_eq!(*value, None, "{name}"),
            }
        }
        assert_eq!(values[2..], [None, None], "{name}");
    };
    expect("map_distance", [Some(0.7), Some(3.0)], 0.02);
    // The radar's range is known to 0.3 m, and radar and LiDAR see the same spot to 0.1 m: 0.7 / 0.31623.
    expect("map_chi", [Some(2.214), Some(10.0)], 0.1);
    // To the middle of a column.
    expect("map_column_distance", [Some(0.7), Some(3.0)], 0.14);
    expect("map_column_sigmas", [Some(2.214), Some(10.0)], 0.45);
    expect("map_column_bottom", [Some(0.2), None], 0.15);
    expect("map_density", [Some(0.0), Some(0.0)], 0.0);
    // Less than 3 m away the wall is seen 76 degrees to each side: in four of eight directions.
    expect("map_octants", [Some(0.5), Some(0.0)], 0.0);
    close(column(&found, "map_column_top")[0], 3.8, 0.15);
}

#[test]
fn the_way_to_a_detection_leads_through_a_wall() {
    let detections = vec![[27.0, 0.0, 1.0], [18.0, 0.0, 1.5], [9.0, 0.0, 1.5], [0.0, 90.0, 1.5]];
    let found = observe(&wall(Elevation::Measured, detections), 0);
    for name in ["sight_behind_surface", "sight_behind_first_tall", "sight_behind_last_tall"] {
        let values = column(&found, name);
        close(values[0], 9.0, 0.35);
        // What is met within two sigmas of range is what was detected itself.
        assert_eq!(values[1..], [Some(0.0), Some(0.0), None], "{name}");
    }
    let heights = column(&found, "sight_surface_height");
    close(heights[0], 3.8, 0.15);
    assert_eq!(heights[1..], [None, None, None]);
    let through = column(&found, "sight_through");
    assert!((0.2..0.7).contains(&through[0].unwrap()), "{through:?}");
    // Looked at 3 m to each side of the way: 25 columns of 0.25 m.
    let length = column(&found, "sight_wall_length");
    assert_eq!(length, [Some(6.25), None, None, None]);
    close(column(&found, "sight_wall_top")[0], 3.8, 0.15);
    // On the wall 12 of 12 x 12 columns are filled, or twice as many where it lies between two rows.
    let tall = column(&found, "sight_footprint_tall")[1].unwrap();
    assert!((12.0 / 144.0..=24.0 / 144.0).contains(&tall), "{tall}");
    assert_eq!(column(&found, "sight_footprint_cars")[1..3], [Some(0.0), Some(0.0)]);
}

#[test]
fn without_elevation_the_map_is_asked_at_a_supposed_height() {
    let found = observe(&wall(Elevation::None, vec![[17.0, 0.0, 0.0], [27.0, 0.0, 0.0]]), 0);
    close(column(&found, "map_distance")[0], 1.0, 0.02);
    close(column(&found, "sight_behind_surface")[1], 9.0, 0.35);
}

/// The nearest point in the plane may lie far above: how high it is, such a radar can't tell.
#[test]
fn without_elevation_a_tall_facade_is_as_near_as_a_low_one() {
    let facade = |z: f32| [60.0, 0.0, z];
    let memory = Memory::new(0.0)
        .radar(radar(Elevation::None), vec![(0, Some(vec![[59.5, 0.0, 0.0]]))])
        .lidar(crate::support::lidar(), vec![(0, (0..40).map(|k| facade(5.0 + 0.1 * k as f32)).collect())]);
    let found = observe(&memory, 0);
    close(column(&found, "lidar_distance")[0], 0.5, 1e-3);
    assert!(column(&found, "lidar_residual_horizontal")[0].is_some());
}

#[test]
fn scans_that_saw_it_again_place_it_on_the_wall() {
    // The radar tells the wall half a metre too near in the scan that is asked, and where it is in those around.
    let fields = ["x", "y", "z", "doppler"].map(str::to_owned).to_vec();
    let scan = |k: i64| {
        let ahead = 20.0 - k as f32 - if k == 2 { 0.5 } else { 0.0 };
        (k * 100 * MS, vec![[ahead, 0.0, 1.5, -10.0]])
    };
    let radar = Radar { fields, ..radar(Elevation::Measured) };
    let memory = before_wall(Memory::new(10.0).measured(radar, (0..5).map(scan).collect()));
    let found = observe(&memory, 2);
    close(column(&found, "map_distance")[0], 0.5, 0.03);
    // Of five scans that know it as well one is off.
    close(column(&found, "map_joint_distance")[0], 0.1, 0.03);
    close(column(&found, "persistence_shift")[0], 0.4 / 0.31623, 0.02);
}
