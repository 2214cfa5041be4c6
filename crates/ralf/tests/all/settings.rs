//! Settings at the ends of their ranges: none may end a run.

use crate::support::{MS, Memory, lidar, radar};
use ralf::config::Config;
use ralf::sensors::Elevation;

/// A few scans, of which each branch but the cameras' says something.
fn memory() -> Memory {
    let wall: Vec<[f32; 3]> =
        (0..40).map(|i| [10.0, 0.25 * (i % 8) as f32 - 1.0, 0.3 * (i / 8) as f32]).collect();
    let road = (0..40).map(|i| [3.0 + (i % 8) as f32, (i / 8) as f32 - 2.0, -2.0]);
    let points = wall.iter().map(|[x, y, z]| [*x, *y, *z - 2.0]).chain(road).collect();
    let scans = (0..4).map(|scan| (scan * 60 * MS, Some(wall[..10].to_vec()))).collect();
    Memory::new(1.0).radar(radar(Elevation::Measured), scans).lidar(lidar(), vec![(0, points)])
}

/// The ranges as the page has them: dotted name, and the values at both ends.
fn ends() -> Vec<(String, [String; 2])> {
    let mut section = String::new();
    let mut ends = Vec::new();
    for line in include_str!("../../../../config/default.toml").lines() {
        if let Some(name) = line.strip_prefix('[') {
            section = name.trim_end_matches(']').to_owned() + ".";
        }
        let Some((setting, comment)) = line.split_once('#') else { continue };
        let Some((key, default)) = setting.split_once('=') else { continue };
        let Some((range, _)) = comment.trim_start_matches([' ', '[', '(']).split_once(']') else { continue };
        let Some((low, high)) = range.split_once(", ") else { continue };
        let above = if comment.trim_start().starts_with('(') { 1e-9 } else { 0.0 };
        let whole = !default.contains('.');
        let text = |value: f64| if whole { format!("{}", value as i64) } else { format!("{value:?}") };
        let numbers = [low, high].map(|number| number.parse::<f64>().unwrap());
        ends.push((format!("{section}{}", key.trim()), [text(numbers[0] + above), text(numbers[1])]));
    }
    ends
}

#[test]
fn every_number_may_be_at_either_end_of_its_range() {
    let (memory, ends) = (memory(), ends());
    assert!(ends.len() > 25, "{ends:?}");
    for (key, values) in ends {
        for value in values {
            let config = Config::from_toml("", &[&format!("{key}={value}")]).unwrap();
            for scan in [0, 3] {
                let labels = memory.label(&config, 0, scan);
                assert!(labels.iter().all(|label| (0.0..=1.0).contains(&label.w)), "{key} = {value}");
            }
        }
    }
}

#[test]
fn counts_that_would_fill_the_memory_are_refused_by_name() {
    for key in ["lidar.neighbours", "camera.neighbours", "camera.scale_neighbours", "tracking.neighbours"] {
        for value in ["0", "4000000000", "9223372036854775807"] {
            let error = Config::from_toml("", &[&format!("{key}={value}")]).unwrap_err().to_string();
            assert!(error.contains(key) && error.contains("1 to 1000"), "{error}");
        }
    }
    for (key, value) in
        [("tracking.scans", "4e9"), ("camera.stride", "-1"), ("evidence.lidar_scans", "1000000")]
    {
        assert!(Config::from_toml("", &[&format!("{key}={value}")]).is_err(), "{key}");
    }
}
