//! Height above the ground, steps, and places whose ground nobody saw.

use super::{close, column, observe};
use crate::support::{MS, Memory, lidar, radar};
use ralf::sensors::Elevation;

/// A road with a pavement 0.15 m above it from y = 3 m on, up to 30 m around, as a LiDAR 2 m above the road sees it
/// that drives 1 m from scan to scan; the radar's scan is the second of three.
fn memory(elevation: Elevation, detections: Vec<[f32; 3]>) -> Memory {
    let road = |driven: f32| -> Vec<[f32; 3]> {
        let cells = (-120..120).flat_map(|i| (-120..120).map(move |j| (i as f32 * 0.25, j as f32 * 0.25)));
        cells.map(|(x, y)| [x - driven, y, if y >= 3.0 { -1.85 } else { -2.0 }]).collect()
    };
    let scans = (0..3).map(|scan| (scan * 100 * MS, road(scan as f32))).collect();
    Memory::new(10.0).radar(radar(elevation), vec![(100 * MS, Some(detections))]).lidar(lidar(), scans)
}

#[test]
fn heights_and_steps_by_hand() {
    let detections =
        vec![[10.0, 0.0, 0.5], [10.0, 6.0, 0.05], [10.0, 3.1, 1.0], [60.0, 0.0, 0.0], [f32::NAN; 3]];
    let found = observe(&memory(Elevation::Measured, detections), 0);
    let heights = column(&found, "ground_height");
    for (height, expected) in heights.iter().zip([0.5, -0.1]) {
        close(*height, expected, 0.005);
    }
    assert_eq!(heights[3..], [None, None], "nobody saw the ground there");
    // The radar knows the height by 10 * 0.02 = 0.2 m, the surface by 0.05: 0.5 / 0.20616 = 2.4254.
    close(column(&found, "ground_height_sigmas")[0], 2.4254, 0.03);
    for (step, expected) in column(&found, "ground_step").iter().zip([0.0, 0.0, 0.15]) {
        close(*step, expected, 1e-3);
    }
    // The farthest road is 29.75 - 1 m ahead, in the cell whose middle is at 28.75 m.
    let unseen = column(&found, "ground_unseen");
    close(unseen[0], 0.0, 0.0);
    close(unseen[3], 31.5, 0.5);
}

#[test]
fn a_radar_without_elevation_has_no_height_but_a_place() {
    let found = observe(&memory(Elevation::None, vec![[10.0, 3.1, 0.0]]), 0);
    assert_eq!(column(&found, "ground_height"), [None]);
    assert_eq!(column(&found, "ground_height_sigmas"), [None]);
    close(column(&found, "ground_step")[0], 0.15, 1e-3);
}

#[test]
fn without_lidar_there_is_no_ground() {
    let memory = Memory::new(0.0).radar(radar(Elevation::Measured), vec![(0, Some(vec![[10.0, 0.0, 0.5]]))]);
    let found = observe(&memory, 0);
    for name in ["ground_height", "ground_height_sigmas", "ground_step", "ground_unseen"] {
        assert_eq!(column(&found, name), [None]);
    }
}

#[test]
fn ground_that_is_as_bright_everywhere_tells_nothing() {
    let found = observe(&memory(Elevation::Measured, vec![[10.0, 0.0, 0.5]]), 0);
    for name in ["terrain_brightness", "terrain_mottling", "terrain_roughness"] {
        assert_eq!(column(&found, name), [None]);
    }
}
