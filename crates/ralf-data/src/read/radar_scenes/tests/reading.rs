//! What is read of a good recording, and what is true of it.

use super::hdf5::Values;
use super::recording::{SCANS, SPEED, T0, sequence, write_dataset, write_sequence};
use crate::Label;
use crate::read::Recording;
use crate::read::radar_scenes::{open, recognises};
use crate::testing::only;
use crate::truth::GroundTruth;
use std::fs;

fn dataset() -> (tempfile::TempDir, Recording) {
    let folder = tempfile::tempdir().unwrap();
    write_dataset(folder.path());
    let recording = open(folder.path(), &[]).unwrap();
    (folder, recording)
}

#[test]
fn a_sequence_and_the_whole_set_are_recognised() {
    let (folder, _) = dataset();
    for path in ["", "data", "data/sequence_1"] {
        let path = folder.path().join(path);
        assert!(recognises(&path));
        let recording = crate::read::open(&path, None).unwrap();
        assert_eq!((recording.format, recording.sequences.len()), ("radarscenes", 1));
        assert_eq!(only(&recording).sequence().name, "sequence_1");
        assert_eq!(only(&recording).sequence().title, "RadarScenes, train");
        assert_eq!(only(&recording).inputs().len(), 3);
    }
    assert!(!recognises(tempfile::tempdir().unwrap().path()));
}

#[test]
fn scenes_are_scans_of_their_radar_and_no_row_is_dropped() {
    let (_folder, recording) = dataset();
    let sequence = only(&recording).sequence();
    let names: Vec<&str> = sequence.rig.radars.iter().map(|radar| radar.name.as_str()).collect();
    assert_eq!(names, ["radar_2", "radar_3"]);
    assert!(sequence.rig.lidars.is_empty());
    let times = |after: i64| -> Vec<i64> {
        (0..SCANS as i64).map(|scan| (T0 + 60_000 * scan + after) * 1000).collect()
    };
    assert_eq!(sequence.times.radars, [times(0), times(12_250)]);
    let rows = |r, s| only(&recording).radar_scan(r, s).unwrap().len();
    let counts: Vec<usize> = [0, 1].iter().flat_map(|r| (0..SCANS).map(|s| rows(*r, s))).collect();
    assert_eq!(counts, [5, 5, 5, 5, 5, 5, 0, 5]);
    assert!(only(&recording).warnings().is_empty());
}

#[test]
fn places_speeds_and_poses_agree() {
    let (_folder, recording) = dataset();
    let reader = only(&recording);
    let motion = &reader.sequence().motion;
    for (r, radar) in reader.sequence().rig.radars.iter().enumerate() {
        let scan = reader.radar_scan(r, 3).unwrap();
        let column = |name: &str| &scan.columns[radar.column(name).unwrap()];
        for (row, position) in scan.positions.iter().enumerate() {
            let place = radar.vehicle_from_radar * position;
            let [x, y] = ["x_cc", "y_cc"].map(|name| f64::from(column(name)[row]));
            assert!((place.x - x).hypot(place.y - y) < 1e-4, "{place}");
            // The poses begin 30 ms before the first scan.
            let moved = motion.odom_from_vehicle(scan.t_ns) * place;
            let [x, y] = ["x_seq", "y_seq"].map(|name| f64::from(column(name)[row]));
            assert!((moved.x + 512.0 - 0.03 * SPEED - x).hypot(moved.y - 64.0 - y) < 1e-3, "{moved}");
        }
        let computed = ralf::scene::Doppler::new(radar, &scan, motion).unwrap();
        assert!((computed.raw[0] + computed.raw[0].abs()).abs() < 1e-9, "posts come nearer");
        let [raw, compensated] = ["doppler", "doppler_compensated"].map(&column);
        assert!(raw[3].abs() < 1e-6 && (compensated[3] - 8.0).abs() < 0.2 && compensated[0] == 0.0);
    }
}

#[test]
fn the_vehicle_goes_on_where_radars_outlast_the_odometry() {
    let (folder, _) = dataset();
    let mut cut = sequence(false);
    // A quarter of a turn a second, and the last row 110 ms before the last scan.
    for (name, values) in &mut cut.odometry {
        match values {
            Values::Long(values) => values.truncate(11),
            Values::Double(values) => values.truncate(11),
            Values::Float(values) => *values = vec![if *name == "vx" { 8.0 } else { 1.5 }; 11],
            _ => unreachable!(),
        }
    }
    write_sequence(&folder.path().join("data/sequence_1"), &cut);
    let recording = open(folder.path(), &[]).unwrap();
    let motion = &only(&recording).sequence().motion;
    let [last_ns, scan_ns] = [70_000, 180_000].map(|us| (T0 + us) * 1000);
    let moved = motion.between(last_ns, scan_ns);
    let turn: f64 = 1.5 * 0.11;
    let [x, y] = [SPEED / 1.5 * turn.sin(), SPEED / 1.5 * (1.0 - turn.cos())];
    // Between two poses the vehicle is on the chord, up to 4 mm beside the arc.
    assert!((moved.translation.x - x).hypot(moved.translation.y - y) < 5e-3, "{moved}");
    assert!((moved.rotation.angle() - turn).abs() < 1e-3, "{moved}");
}

#[test]
fn labels_of_the_authors_and_of_clutter_ds_are_told_apart() {
    let (folder, recording) = dataset();
    let ids = |recording: &Recording| -> Vec<u16> {
        only(recording).truth(0, 0).unwrap().unwrap().labels.iter().map(|label| label.id).collect()
    };
    assert_eq!(ids(&recording), [0, 0, 0, 252, 0]);
    let car = only(&recording).truth(1, 3).unwrap().unwrap().labels[3];
    assert_eq!(car, Label { id: 252, instance: 1 });
    let truth = GroundTruth::open(folder.path()).unwrap();
    assert_eq!(truth.scans().len(), 2 * SCANS);
    assert!(truth.causes("sequence_1").unwrap().is_none());
    write_sequence(&folder.path().join("data/sequence_1"), &sequence(true));
    let relabelled = open(folder.path(), &[]).unwrap();
    assert_eq!(ids(&relabelled), [0, 0, 0, 99, 1]);
    assert!(only(&relabelled).sequence().title.ends_with(", labels of clutter-ds"));
    let converted = tempfile::tempdir().unwrap();
    crate::write_sequence(only(&relabelled), converted.path(), &|_| ()).unwrap();
    let written = GroundTruth::open(converted.path()).unwrap();
    assert_eq!(
        written.labels(&written.scans()[0]).unwrap(),
        only(&relabelled).truth(0, 0).unwrap().unwrap().labels
    );
    assert!(written.causes("sequence_1").unwrap().is_none());
}

#[test]
fn what_is_missing_or_left_out_is_told() {
    let (folder, _) = dataset();
    fs::remove_file(folder.path().join("data/sensors.json")).unwrap();
    fs::create_dir(folder.path().join("data/sequence_1/camera")).unwrap();
    let recording = open(folder.path(), &[]).unwrap();
    let [mountings, camera] = only(&recording).warnings() else { panic!("two warnings") };
    assert!(mountings.contains("no sensors.json") && camera.contains("no calibration"));
    assert_eq!(only(&recording).inputs().len(), 2);
    let (_other, told) = dataset();
    let mounting = |recording: &Recording| only(recording).sequence().rig.radars[1].vehicle_from_radar;
    assert_eq!(mounting(&recording), mounting(&told));
}
