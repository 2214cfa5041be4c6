//! Pieces of evidence on recordings of a few points, with numbers worked out by hand.

use crate::support::{Memory, lidar, radar};
use proptest::prelude::*;
use ralf::config::Config;
use ralf::evidence::{self, Column, GROUPS};
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
use ralf::sensors::Elevation;
use std::collections::BTreeSet;

fn config() -> Config {
    Config::from_toml("", &["ground.model=none", "lidar.neighbours=1", "ground.radar_sigmas=0"]).unwrap()
}

/// The evidence on the first scan.
fn observe(memory: &Memory) -> Vec<Column> {
    let config = config();
    let mut window = FrameWindow::new(memory, &memory.sequence.rig, &config).with_evidence();
    evidence::observe(&window.frame(0, 0).unwrap(), &config)
}

fn column<'a>(columns: &'a [Column], name: &str) -> &'a [Option<f64>] {
    &columns.iter().find(|column| column.feature.name == name).expect("a column of this name").values
}

fn close(found: Option<f64>, expected: f64) {
    let found = found.expect("a value");
    assert!((found - expected).abs() < 1e-4 * expected.abs().max(1e-3), "found {found}, expected {expected}");
}

/// Detections of a radar at the vehicle's origin, and points of a LiDAR 2 m above it.
fn memory(elevation: Elevation, detections: Vec<[f32; 3]>, points: Vec<[f32; 3]>) -> Memory {
    Memory::new(0.0).radar(radar(elevation), vec![(0, Some(detections))]).lidar(lidar(), vec![(0, points)])
}

#[test]
fn the_lidar_residual_by_hand() {
    // Two detections 10 m ahead, level with the radar; in the vehicle frame the point lies at (10.5, 0, 0.4).
    let nan = [f32::NAN, 0.0, 0.0];
    let found = observe(&memory(Elevation::Measured, vec![[10.0, 0.0, 0.0], nan], vec![[10.5, 0.0, -1.6]]));
    // Horizontal: h = (-0.5, 0). The radar's range knows x by 0.3; the LiDAR's ray is (10.5, 0, -1.6) / 10.62121, along
    // x 0.988588 of its 0.04 m. 0.5 / sqrt(0.09 + 0.0015637 + 0.000001) = 1.65237.
    close(column(&found, "lidar_residual_horizontal")[0], 1.65237);
    // Vertical: h = -0.4. The radar's elevation knows height by 10 * 0.02 = 0.2; of the LiDAR's 0.04 m the ray has
    // 1.6 / 10.62121 = 0.150642 in height. -0.4 / sqrt(0.04 + 0.0000363 + 0.000001) = -1.99907.
    close(column(&found, "lidar_residual_vertical")[0], -1.99907);
    // sqrt(0.5^2 + 0.4^2).
    close(column(&found, "lidar_distance")[0], 0.640312);
    assert!(found.iter().all(|column| column.values.len() == 2 && column.values[1].is_none()));
}

#[test]
fn what_the_lidar_does_not_see_is_null() {
    let detections = vec![[10.0, 0.0, 0.0]];
    let without_scan =
        Memory::new(0.0).radar(radar(Elevation::Measured), vec![(0, Some(detections.clone()))]);
    let without_points = memory(Elevation::Measured, detections.clone(), vec![]);
    for memory in [without_scan, without_points] {
        let found = observe(&memory);
        for name in ["lidar_distance", "lidar_residual_horizontal", "lidar_residual_vertical"] {
            assert_eq!(column(&found, name), [None]);
        }
    }
    let far = observe(&memory(Elevation::Measured, detections.clone(), vec![[15.1, 0.0, -2.0]]));
    assert_eq!(column(&far, "lidar_distance"), [None], "none is within 5 m");
    let level = observe(&memory(Elevation::None, detections, vec![[10.5, 0.0, -2.0]]));
    assert!(column(&level, "lidar_residual_horizontal")[0].is_some());
    assert_eq!(column(&level, "lidar_residual_vertical"), [None], "a radar without elevation has no height");
    let above = observe(&memory(Elevation::None, vec![[10.0, 0.0, 0.0]], vec![[10.5, 0.0, -0.5]]));
    close(column(&above, "lidar_distance")[0], 0.5);
}

proptest! {
    /// Where the residual is horizontal or vertical alone, its part is the paper's own mismatch.
    #[test]
    fn a_residual_of_one_part_is_the_papers_mismatch(
        [x, y] in prop::array::uniform2(3.0f32..30.0), z in 0.5f32..3.0, offset in 0.1f32..2.0, up in any::<bool>(),
    ) {
        let lidar_height = 2.0;
        let point = if up { [x, y, z + offset - lidar_height] } else { [x + offset, y, z - lidar_height] };
        let memory = memory(Elevation::Measured, vec![[x, y, z]], vec![point]);
        let config = config();
        let mut window = FrameWindow::new(&memory, &memory.sequence.rig, &config);
        let frame = window.frame(0, 0).unwrap();
        let d_lm = Labeler::new(&config).unwrap().label(&frame)[0].d_lm.unwrap();
        let found = evidence::observe(&frame, &config);
        let [horizontal, vertical] =
            ["lidar_residual_horizontal", "lidar_residual_vertical"].map(|name| column(&found, name)[0].unwrap());
        // The scan's numbers are of single precision: what should be 0 may be a micrometre.
        let (part, other) = if up { (-vertical, horizontal) } else { (horizontal, vertical) };
        prop_assert!((part - d_lm).abs() < 1e-3 * d_lm && other.abs() < 1e-2, "{part} {other} {d_lm}");
    }
}

#[test]
fn every_column_has_a_name_of_its_own_and_is_documented() {
    let page = include_str!("../../../../docs/evidence.md");
    let rows: Vec<&str> = page.lines().filter(|line| line.starts_with("| `")).collect();
    let mut names = BTreeSet::new();
    for feature in evidence::features() {
        assert!(names.insert(feature.name), "{} twice", feature.name);
        assert!(GROUPS.contains(&feature.group), "{} belongs to {}", feature.name, feature.group);
        assert!(feature.name.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit() || c == '_'));
        let row =
            format!("| `{}` | {} | {} | {} |", feature.name, feature.unit, feature.group, feature.meaning);
        assert!(rows.contains(&row.as_str()), "docs/evidence.md lacks the row\n{row}");
    }
    assert_eq!(rows.len(), names.len(), "docs/evidence.md has a row of no column");
}
