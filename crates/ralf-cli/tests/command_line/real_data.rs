//! Whole runs on real recordings.

use crate::support::{ralf, rows};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Command;

/// A folder of the real recordings, where the environment names them; else the test says that it is skipped.
fn data(name: &str) -> Option<String> {
    let folder = std::env::var_os("RALF_TEST_DATA").map(|root| Path::new(&root).join(name));
    if folder.is_none() {
        println!("skipped: RALF_TEST_DATA is not set");
    }
    Some(folder?.to_str().unwrap().to_owned())
}

/// What `ralf check` says of recordings that are known to be good: a line each.
#[test]
fn good_real_recordings_raise_nothing() {
    let recordings = [
        "nuscenes",
        "view-of-delft",
        "ros/nuscenes-0061.bag",
        "ros/nuscenes-0061-lz4.bag",
        "ros/nuscenes-0061.mcap",
        "ros/nuscenes-0061-lz4.mcap",
        "ros/nuscenes-0061-zstd.mcap",
    ];
    for name in recordings {
        let Some(data) = data(name) else { return };
        ralf(["check", &data, "--strict"]).exits(0).prints(["nothing speaks against it"]);
        println!("{name}: nothing speaks against it");
    }
}

#[test]
fn a_scene_of_nuscenes() {
    let Some(data) = data("nuscenes") else { return };
    let out = tempfile::tempdir().unwrap();
    let record = ralf(["label", &data, "-o", out.path().to_str().unwrap(), "--json"]).exits(0).json();
    let lists = |key: &str| -> Vec<u64> {
        let radars = record["sequences"][0]["radars"].as_array().unwrap().iter();
        radars.flat_map(|radar| radar[key].as_array().unwrap()).map(|value| value.as_u64().unwrap()).collect()
    };
    assert_eq!(lists("detections").len(), 1263);
    assert_eq!(lists("detections").iter().sum::<u64>(), 126_749);
    // There is but one LiDAR revolution: flag 8 everywhere else.
    assert_eq!(lists("flags").iter().filter(|flags| *flags & 8 == 0).count(), 6);
}

/// Whoever has no poses of this scene gets nearly the same labels.
#[test]
#[ignore = "labels a scene twice: cargo test -p ralf-cli --test command_line -- --ignored --nocapture range_rates"]
fn range_rates_in_place_of_poses_give_a_scene_of_nuscenes_nearly_the_same_labels() {
    let Some(data) = data("nuscenes") else { return };
    let folder = tempfile::tempdir().unwrap();
    let labels = |source: &str| -> Vec<Option<i64>> {
        let out = folder.path().join(source);
        let setting = format!("motion.source={source}");
        ralf(["label", &data, "-o", out.to_str().unwrap(), "--no-check", "--quiet", "--set", &setting])
            .exits(0);
        let table = rows(out.join("sequences/scene-0061/plausibility.parquet"));
        table.iter().map(|row| row.whole("label")).collect()
    };
    let [with, without] = ["recorded", "radar"].map(labels);
    let alike = with.iter().zip(&without).filter(|(one, other)| one == other).count();
    let share = alike as f64 / with.len() as f64;
    println!("{:.2} % of {} labels agree", share * 100.0, with.len());
    assert!(with.len() == without.len() && share >= 0.97, "{share}");
}

/// A sidecar has as many values as the cloud that its token leads to has points, by the data set's own tables.
#[test]
fn sidecars_of_a_scene_of_nuscenes() {
    let Some(data) = data("nuscenes") else { return };
    let folder = tempfile::tempdir().unwrap();
    let [out, path] = ["out", "sidecars"].map(|name| folder.path().join(name).to_str().unwrap().to_owned());
    ralf(["label", &data, "-o", &out, "--quiet"]).exits(0);
    ralf(["export", &data, &out, "--to", "nuscenes", "-o", &path]).exits(0);
    let read = |file: String| -> Value { serde_json::from_slice(&fs::read(file).unwrap()).unwrap() };
    let known = read(format!("{data}/v1.0-mini/sample_data.json"));
    let files: BTreeMap<&str, &str> = known
        .as_array()
        .unwrap()
        .iter()
        .map(|row| (row["token"].as_str().unwrap(), row["filename"].as_str().unwrap()))
        .collect();
    let table = read(format!("{path}/v1.0-mini/radarseg.json"));
    let mut values = 0;
    for row in table.as_array().unwrap() {
        let cloud =
            fs::read(format!("{data}/{}", files[row["sample_data_token"].as_str().unwrap()])).unwrap();
        let header = String::from_utf8_lossy(&cloud[..500]);
        let points: usize =
            header.lines().find_map(|line| line.strip_prefix("POINTS ")).unwrap().parse().unwrap();
        let sidecar = fs::read(format!("{path}/{}", row["filename"].as_str().unwrap())).unwrap();
        assert_eq!(sidecar.len(), points);
        values += points;
    }
    assert_eq!((table.as_array().unwrap().len(), values), (1263, 126_749));
}

#[test]
fn a_frame_of_view_of_delft() {
    let Some(data) = data("view-of-delft") else { return };
    let out = tempfile::tempdir().unwrap();
    let out = out.path().to_str().unwrap();
    ralf(["label", &data, "-o", out]).exits(0);
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/vod_boxes.py");
    let Ok(compared) = Command::new("python3").arg(script).args([&data, out]).output() else {
        return println!("skipped: python3 is not there");
    };
    let text = String::from_utf8(compared.stdout).unwrap();
    let share = |line: &str| -> f64 {
        let line = text.lines().find_map(|text| text.strip_prefix(line)).unwrap();
        line.rsplit(": ").next().unwrap().split(' ').next().unwrap().parse().unwrap()
    };
    assert!(share("plausible inside boxes") >= 0.95, "{text}");
    assert!(share("plausible below") <= 0.05, "{text}");
}
