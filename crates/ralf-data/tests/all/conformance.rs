//! What every reader of every format owes to whoever reads with it: the same checks on each of them.

#[path = "../../src/read/aimotive/tests/recording.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
mod aimotive;
#[path = "../../src/disk/hdf5/writing.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
mod hdf5;
#[path = "../../src/read/nvidia/tests/recording.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
mod nvidia;
#[path = "../../src/read/radar_ghost/tests/recording.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
mod radar_ghost;
#[path = "../../src/read/radar_scenes/tests/recording.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
mod radar_scenes;
#[path = "../../src/read/zod/tests/recording.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
mod zod;

use crate::{dataset, truckscenes};
use ralf::scene::Doppler;
use ralf::sensors::SourceError;
use ralf_data::write::export::{RosFormat, write_ros};
use ralf_data::{Recording, SequenceReader};
use std::collections::BTreeSet;
use std::fmt::Debug;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

#[test]
fn own_layout() {
    let (folder, _) = dataset::tiny();
    let recording = ralf_data::open(folder.path(), None).unwrap();
    assert_eq!(recording.format, "ralf");
    check(&recording);
}

#[test]
fn own_layout_as_converted() {
    let (folder, _) = dataset::tiny();
    let out = tempfile::tempdir().unwrap();
    for sequence in &ralf_data::open(folder.path(), None).unwrap().sequences {
        ralf_data::write_sequence(sequence.as_ref(), out.path(), &|_| ()).unwrap();
    }
    check(&ralf_data::open(out.path(), Some("ralf")).unwrap());
}

#[test]
fn aimotive_as_published() {
    let folder = tempfile::tempdir().unwrap();
    aimotive::write_sequence(&folder.path().join("train/highway").join(aimotive::SEQUENCE));
    check_and_convert(&ralf_data::open(folder.path(), None).unwrap(), "aimotive");
}

#[test]
fn truckscenes_as_published() {
    let folder = tempfile::tempdir().unwrap();
    truckscenes::write_data_set(folder.path(), &truckscenes::TINY);
    check_and_convert(&ralf_data::open(folder.path(), None).unwrap(), "truckscenes");
}

#[test]
fn zod_as_published() {
    let folder = tempfile::tempdir().unwrap();
    zod::write_data_set(folder.path());
    check_and_convert(&ralf_data::open(folder.path(), None).unwrap(), "zod");
}

#[test]
fn radar_ghost_as_published() {
    let folder = tempfile::tempdir().unwrap();
    radar_ghost::write_dataset(folder.path());
    check_and_convert(&ralf_data::open(folder.path(), None).unwrap(), "radar-ghost");
}

#[test]
fn radar_scenes_as_published() {
    let folder = tempfile::tempdir().unwrap();
    radar_scenes::write_dataset(folder.path());
    check_and_convert(&ralf_data::open(folder.path(), None).unwrap(), "radarscenes");
}

#[test]
fn nvidia_as_published() {
    let folder = tempfile::tempdir().unwrap();
    nvidia::write_unzipped(folder.path());
    nvidia::write_clip(&folder.path().join("clips"));
    check_and_convert(&ralf_data::open(folder.path(), None).unwrap(), "nvidia");
    check_and_convert(&ralf_data::open(&folder.path().join("clips"), None).unwrap(), "nvidia");
}

/// Written as bags and MCAP files and read again, with a guess of the topics.
#[test]
fn the_recording_of_the_demonstration_as_ros_recordings() {
    let Some(folder) = demonstration() else { return };
    let out = tempfile::tempdir().unwrap();
    let recording = ralf_data::open(folder.path(), None).unwrap();
    for (format, name) in [(RosFormat::Mcap, "one.mcap"), (RosFormat::Bag, "two.bag")] {
        let file = out.path().join(name);
        write_ros(recording.sequences[0].as_ref(), &file, format, &|_| ()).unwrap();
        let written = ralf_data::open(&file, None).unwrap();
        check(&written);
        check_same_measurements(recording.sequences[0].as_ref(), written.sequences[0].as_ref());
    }
}

/// Times, places and values are the same; range rates may have been added to the values.
fn check_same_measurements(before: &dyn SequenceReader, after: &dyn SequenceReader) {
    let [a, b] = [before.sequence(), after.sequence()];
    assert_eq!(a.times, b.times);
    let text = |value: &dyn Debug| format!("{value:?}");
    for (r, (a, b)) in a.rig.radars.iter().zip(&b.rig.radars).enumerate() {
        assert_eq!((&a.name, a.vehicle_from_radar), (&b.name, b.vehicle_from_radar));
        assert_eq!((a.elevation, &a.fields[..]), (b.elevation, &b.fields[..a.fields.len()]));
        for s in 0..before.sequence().times.radars[r].len() {
            let [before, after] = [before, after].map(|reader| reader.radar_scan(r, s).unwrap().columns);
            assert_eq!(text(&before), text(&&after[..before.len()]));
        }
    }
    for (l, times) in a.times.lidars.iter().enumerate() {
        for s in 0..times.len() {
            let [before, after] = [before, after].map(|reader| reader.lidar_scan(l, s).unwrap());
            assert_eq!(text(&(before.points, before.intensity)), text(&(after.points, after.intensity)));
        }
    }
}

#[test]
fn the_recording_of_the_demonstration() {
    let Some(folder) = demonstration() else { return };
    let recording = ralf_data::open(folder.path(), None).unwrap();
    assert!(recording.sequences[0].warnings().is_empty());
    check(&recording);
}

/// Made by a script, where there is what it takes.
fn demonstration() -> Option<TempDir> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/make_tiny.py");
    let out = tempfile::tempdir().unwrap();
    let Ok(status) = Command::new("python3").arg(script).arg(out.path()).status() else {
        println!("skipped: there is no python3");
        return None;
    };
    assert!(status.success());
    Some(out)
}

#[test]
fn nuscenes() {
    check_real("nuscenes", "nuscenes");
}

#[test]
fn view_of_delft() {
    check_real("view-of-delft", "view-of-delft");
}

#[test]
fn ros() {
    check_real("ros/nuscenes-0061-zstd.mcap", "ros");
    check_real("ros/nuscenes-0061-lz4.bag", "ros");
}

/// A real recording, and the same in the own layout.
fn check_real(path: &str, format: &str) {
    let Some(root) = std::env::var_os("RALF_TEST_DATA") else {
        println!("skipped: RALF_TEST_DATA is not set");
        return;
    };
    check_and_convert(&ralf_data::open(&Path::new(&root).join(path), None).unwrap(), format);
}

/// A recording, and the same in the own layout.
fn check_and_convert(recording: &Recording, format: &str) {
    assert_eq!(recording.format, format);
    check(recording);
    let out = tempfile::tempdir().unwrap();
    for sequence in &recording.sequences {
        ralf_data::write_sequence(sequence.as_ref(), out.path(), &|_| ()).unwrap();
    }
    let converted = ralf_data::open(out.path(), None).unwrap();
    check(&converted);
    for (before, after) in recording.sequences.iter().zip(&converted.sequences) {
        check_same(before.as_ref(), after.as_ref());
    }
}

/// A conversion keeps times, sensors, motion, and every value of every radar and LiDAR.
fn check_same(before: &dyn SequenceReader, after: &dyn SequenceReader) {
    assert_eq!(format!("{:?}", before.sequence().rig), format!("{:?}", after.sequence().rig));
    assert_eq!(before.sequence().times, after.sequence().times);
    assert_eq!(before.sequence().motion.odometry(), after.sequence().motion.odometry());
    assert_eq!(before.sequence().motion.poses().len(), after.sequence().motion.poses().len());
    let text = |scan: &dyn Debug| format!("{scan:?}");
    for (r, times) in before.sequence().times.radars.iter().enumerate() {
        for s in 0..times.len() {
            let [before, after] = [before, after].map(|reader| reader.radar_scan(r, s).unwrap().columns);
            assert_eq!(text(&before), text(&after), "radar {r}, scan {s}");
        }
    }
    for (l, times) in before.sequence().times.lidars.iter().enumerate() {
        for s in 0..times.len() {
            let [before, after] = [before, after].map(|reader| reader.lidar_scan(l, s).unwrap());
            assert_eq!(text(&before), text(&after), "LiDAR {l}, scan {s}");
        }
    }
}

/// All checks, on all sequences.
fn check(recording: &Recording) {
    assert!(ralf_data::formats().contains(&recording.format));
    let names: Vec<&str> = recording.sequences.iter().map(|s| s.sequence().name.as_str()).collect();
    assert!(!names.is_empty() && names.is_sorted(), "{names:?}");
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
    for sequence in &recording.sequences {
        check_names(sequence.as_ref());
        check_times(sequence.as_ref());
        check_radars(sequence.as_ref());
        check_lidars(sequence.as_ref());
        check_cameras(sequence.as_ref());
        check_inputs(sequence.as_ref());
    }
}

fn check_names(reader: &dyn SequenceReader) {
    let rig = &reader.sequence().rig;
    let radars = rig.radars.iter().map(|radar| &radar.name);
    let others =
        rig.lidars.iter().map(|lidar| &lidar.name).chain(rig.cameras.iter().map(|camera| &camera.name));
    let names: Vec<_> = radars.chain(others).collect();
    assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len(), "{names:?}");
}

fn check_times(reader: &dyn SequenceReader) {
    let sequence = reader.sequence();
    let (rig, times) = (&sequence.rig, &sequence.times);
    assert_eq!(times.radars.len(), rig.radars.len());
    assert_eq!(times.lidars.len(), rig.lidars.len());
    assert_eq!(times.cameras.len(), rig.cameras.len());
    for timeline in times.radars.iter().chain(&times.lidars).chain(&times.cameras) {
        assert!(timeline.is_sorted());
    }
    assert!(sequence.motion.odometry().is_sorted_by_key(|sample| sample.t_ns));
    assert!(sequence.motion.poses().is_sorted_by_key(|sample| sample.t_ns));
}

fn check_radars(reader: &dyn SequenceReader) {
    let sequence = reader.sequence();
    for (r, (radar, times)) in sequence.rig.radars.iter().zip(&sequence.times.radars).enumerate() {
        radar.check().unwrap();
        for (s, &t_ns) in times.iter().enumerate() {
            let scan = same_twice(|| reader.radar_scan(r, s));
            assert_eq!((scan.t_ns, scan.columns.len()), (t_ns, radar.fields.len()));
            assert!(scan.columns.iter().all(|column| column.len() == scan.len()));
            assert_eq!(scan.spherical.len(), scan.len());
            // Where the motion is known there is a range rate without it.
            let rates = Doppler::new(radar, &scan, &sequence.motion);
            assert_eq!(rates.is_some(), radar.fields.iter().any(|field| field.starts_with("doppler")));
            assert!(rates.is_none_or(|rates| rates.compensated.len() == scan.len()));
        }
        assert!(reader.radar_scan(r, times.len()).is_err());
    }
    assert!(reader.radar_scan(sequence.rig.radars.len(), 0).is_err());
}

fn check_lidars(reader: &dyn SequenceReader) {
    let sequence = reader.sequence();
    for (l, (lidar, times)) in sequence.rig.lidars.iter().zip(&sequence.times.lidars).enumerate() {
        lidar.check().unwrap();
        for (s, &t_ns) in times.iter().enumerate() {
            let scan = same_twice(|| reader.lidar_scan(l, s));
            assert_eq!((scan.t_ns, scan.intensity.len()), (t_ns, scan.points.len()));
            let has_times =
                |times: &Vec<f32>| times.len() == scan.points.len() && times.iter().all(|t| t.is_finite());
            assert!(scan.times.as_ref().is_none_or(has_times));
            assert!(scan.classes.is_none_or(|classes| classes.len() == scan.points.len()));
        }
        assert!(reader.lidar_scan(l, times.len()).is_err());
    }
    assert!(reader.lidar_scan(sequence.rig.lidars.len(), 0).is_err());
}

fn check_cameras(reader: &dyn SequenceReader) {
    let sequence = reader.sequence();
    for (c, (camera, times)) in sequence.rig.cameras.iter().zip(&sequence.times.cameras).enumerate() {
        for i in 0..times.len() {
            let image = reader.image(c, i).unwrap();
            assert!(reader.image(c, i).unwrap() == image, "image {i} of {c}, read again");
            assert_eq!((image.width, image.height), (camera.width, camera.height));
            assert_eq!(image.rgb.len(), image.width * image.height);
            if let Some(depth) = same_twice(|| reader.depth(c, i)) {
                assert_eq!(depth.len(), camera.views.len().max(1));
                assert!(depth.iter().all(|view| view.values.len() == view.width * view.height));
            }
            assert!(reader.image_file(c, i).is_none_or(|file| file.is_file()));
        }
        assert!(reader.image(c, times.len()).is_err() && reader.depth(c, times.len()).is_err());
        assert!(reader.image_file(c, times.len()).is_none());
    }
    let none = sequence.rig.cameras.len();
    assert!(reader.image(none, 0).is_err() && reader.depth(none, 0).is_err());
    assert!(reader.image_file(none, 0).is_none());
}

fn check_inputs(reader: &dyn SequenceReader) {
    let inputs = reader.inputs();
    assert_eq!(inputs, reader.inputs());
    assert!(inputs.iter().all(|file| file.is_file()), "{inputs:?}");
    assert_eq!(inputs.iter().collect::<BTreeSet<_>>().len(), inputs.len(), "{inputs:?}");
}

/// What is read, which a second reading gives again. Compared as text, where NaN equals itself.
fn same_twice<T: Debug>(read: impl Fn() -> Result<T, SourceError>) -> T {
    let first = read().unwrap();
    assert_eq!(format!("{first:?}"), format!("{:?}", read().unwrap()));
    first
}
