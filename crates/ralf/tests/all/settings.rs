//! Settings at the ends of their ranges: none may end a run.

use crate::support::{MS, Memory, lidar, radar};
use ralf::config::Config;
use ralf::paper::Labeler;
use ralf::scene::FrameWindow;
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

/// Whoever doesn't come by RALF's own reader: by serde, or by fields.
#[test]
fn numbers_out_of_range_are_refused_wherever_settings_go_in() {
    for (text, named) in [
        ("[lidar]\nneighbours = 0", "setting `lidar.neighbours`: expected 1 to 1000, found 0"),
        ("[camera]\nstride = 0", "setting `camera.stride`: expected 1 to "),
        ("[fusion]\nalpha = nan", "setting `fusion.alpha`: expected 0 to 1, found NaN"),
    ] {
        let error = toml::from_str::<Config>(text).unwrap_err().to_string();
        assert!(error.contains(named), "{error}");
    }
    let mut config = Config::default();
    config.lidar.neighbours = 0;
    config.lidar.scans = 0;
    let refused = "setting `lidar.neighbours`: expected 1 to 1000, found 0";
    assert_eq!(Labeler::new(&config).unwrap_err().to_string(), refused);
    let memory = memory();
    let mut window = FrameWindow::new(&memory, &memory.sequence.rig, &config).with_evidence();
    assert_eq!(window.frame(0, 0).unwrap_err().to_string(), refused);
    assert_eq!(window.lidar_view(0).unwrap_err().to_string(), refused);
    let mut rig = memory.sequence.rig.clone();
    assert_eq!(config.apply_to(&mut rig, &[]).unwrap_err().to_string(), refused);
}

#[test]
fn a_rig_is_changed_as_a_whole_or_not_at_all() {
    let assignments = ["sensors.lidar.sigma_range_m=0.5", "sensors.radar.sigma_range_m=-1"];
    let config = Config::from_toml("", &assignments).unwrap();
    let mut rig = memory().sequence.rig;
    let error = config.apply_to(&mut rig, &[]).unwrap_err().to_string();
    assert!(error.contains("sensors.radar") && error.contains("found -1"), "{error}");
    assert_eq!((rig.lidars[0].sigma_range, rig.radars[0].sigma_range), (0.04, 0.3));
}
