//! `--split`: a detection that is left out is in no file; where labels belong to other clouds, it is unlabeled.

use super::{Found, export, found, list, run, small};
use crate::support::{ralf, read_export, tree};
use serde_json::Value;
use std::fs;

/// The detections that an export holds, by place.
fn places(read: &Value) -> Vec<String> {
    let place = |row: &Value| format!("{} {} {}", row["radar"], row["scan"], row["point"]);
    list(read).iter().map(place).collect()
}

#[test]
fn the_two_kinds_are_apart_and_together_all() {
    let dataset = small();
    for (format, more) in [("npz", None), ("parquet", None), ("semantickitti", Some("--sensors"))] {
        let read = |split: &str| {
            let more: Vec<&str> = ["--split", split].into_iter().chain(more).collect();
            read_export(format, &export(&dataset, format, &format!("{format}-{split}"), &more))
        };
        let Some(plausible) = read("plausible") else { return };
        let [artifact, all] = ["artifact", "all"].map(|split| read(split).unwrap());
        assert!(list(&plausible).iter().all(|row| row["label"] != 1), "{format}");
        assert!(list(&artifact).iter().all(|row| row["label"] == 1), "{format}");
        let mut both = [places(&plausible), places(&artifact)].concat();
        let mut all = places(&all);
        both.sort_unstable();
        all.sort_unstable();
        assert_eq!(both, all, "{format}");
    }
}

#[test]
fn labels_of_other_clouds_keep_their_order() {
    let dataset = small();
    let path = export(&dataset, "semantickitti", "kitti", &["--split", "plausible"]);
    for found in found(&dataset, "00") {
        let number = if found.radar == "radar_front" { "00" } else { "01" };
        let labels = fs::read(format!("{path}/sequences/{number}/labels/{:06}.label", found.scan)).unwrap();
        let label = labels.as_chunks::<4>().0[found.point as usize];
        let expected = if found.label == 99 { 99 } else { 0 };
        assert_eq!(u32::from_le_bytes(label), expected);
    }
    assert!(tree(&path).keys().all(|name| !name.contains("points")));
}

#[test]
fn clouds_of_one_kind_tell_which_points_they_are() {
    let dataset = small();
    let more = ["--sensors", "--split", "artifact"];
    let path = export(&dataset, "semantickitti", "kitti", &more);
    let points = fs::read(format!("{path}/sequences/00/points/000001.npy")).unwrap();
    let expected: Vec<u8> = found(&dataset, "00")
        .iter()
        .filter(|found| found.radar == "radar_front" && found.scan == 1 && found.label == 1)
        .flat_map(|found| (found.point as u32).to_le_bytes())
        .collect();
    assert!(points.ends_with(&expected) && !expected.is_empty());
    let cloud = fs::read(format!("{path}/sequences/00/velodyne/000001.bin")).unwrap();
    assert_eq!(cloud.len(), expected.len() * 4);
}

/// Of a recording that isn't ROS, the radars' own clouds are written by RALF.
#[test]
fn the_clouds_of_radars_hold_one_kind_alone_and_copied_messages_are_refused() {
    let dataset = small();
    let artifacts: Vec<Found> = found(&dataset, "00").into_iter().filter(|found| found.label == 1).collect();
    for (format, ending) in [("mcap", "mcap"), ("rosbag1", "bag")] {
        for sensors in ["--sensors", "--sensors=radar"] {
            let name = format!("{format}{}.{ending}", sensors.len());
            let path = export(&dataset, format, &name, &["--split", "artifact", sensors]);
            let Some(read) = read_export(format, &path) else { return };
            for radar in ["radar_front", "radar_left"] {
                let expected = artifacts.iter().filter(|found| found.radar == radar).count();
                let of = |topic: &str| {
                    list(&read).iter().filter(|row| row["sensor"] == radar && row["topic"] == topic).count()
                };
                assert_eq!(
                    [of("points_labelled"), of("points")],
                    [expected; 2],
                    "{format} {sensors} {radar}"
                );
            }
        }
        // A recording of the same kind, whose messages are copied as they are.
        let [file, settings, out] = [format!("own.{ending}"), "own.toml".to_owned(), format!("own-{ending}")]
            .map(|name| dataset.beside(&name));
        ralf(["convert", &dataset.path, "-o", &file]).exits(0);
        ralf(["label", &file, "-o", &out, "--config", &settings]).exits(0);
        let path = dataset.beside(&format!("copied-{ending}"));
        let split =
            |sensors| ["export", &file, &out, "--to", format, "-o", &path, "--split", "plausible", sensors];
        ralf(split("--sensors")).exits(1).says(["split: expected all detections", "--sensors=lidar,camera"]);
        assert!(!std::path::Path::new(&path).exists());
        ralf(split("--sensors=lidar,camera")).exits(0);
        fs::remove_file(&settings).unwrap();
    }
    run(&dataset, "mcap", &dataset.beside("all"), &["--split", "all", "--sensors"]).exits(0);
}
