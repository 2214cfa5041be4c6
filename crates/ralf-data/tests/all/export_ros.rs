//! Recordings as MCAP files and bags, and back: what both can hold is kept.

use crate::dataset::{SEQUENCE_TOML, tiny, write};
use ralf::sensors::{Rig, Source};
use ralf::space::Transform;
use ralf_data::run::{LabelRun, Unwatched};
use ralf_data::write::export::{Export, ExportFormat, ExportOptions, RosFormat, Sensors, Split, write_ros};
use ralf_data::{LayoutSequence, Recording, SequenceReader, Settings, open, open_with, write_sequence};
use ralf_ros::container::Container;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

/// A sequence that ROS can hold: no time before 1970, and a camera without views.
pub(crate) fn sequence() -> (TempDir, PathBuf) {
    let (folder, path) = tiny();
    write(&path.join("radar_rear/timestamps.txt"), "7\n30000000\n");
    let views = SEQUENCE_TOML.find("[[camera.view]]").unwrap();
    write(&path.join("sequence.toml"), &SEQUENCE_TOML[..views]);
    (folder, path)
}

/// The sequence as a recording of this format, read back by the settings that were written beside it.
fn converted(reader: &LayoutSequence, folder: &Path, format: RosFormat) -> (Recording, Settings) {
    let file = folder.join("street").with_extension(format.extension());
    let settings = write_ros(reader, &file, format, &|_| {}).unwrap().settings.unwrap();
    let config = Settings::from_toml(&fs::read_to_string(settings).unwrap(), &[]).unwrap();
    (open_with(&file, None, &config.topics).unwrap(), config)
}

fn same_place(a: &Transform, b: &Transform) {
    assert!((a.translation.vector - b.translation.vector).norm() < 1e-12, "{a} {b}");
    assert!(a.rotation.angle_to(&b.rotation) < 1e-7, "{a} {b}");
}

/// All but names of titles and mountings to the last digit.
fn same_rig(found: &Rig, expected: &Rig) {
    assert_eq!((found.radars.len(), found.lidars.len(), found.cameras.len()), (2, 1, 1));
    for (found, expected) in found.radars.iter().zip(&expected.radars) {
        same_place(&found.vehicle_from_radar, &expected.vehicle_from_radar);
        assert_eq!(
            (&found.name, &found.fields, found.elevation),
            (&expected.name, &expected.fields, expected.elevation)
        );
        let sigmas = |radar: &ralf::sensors::Radar| {
            let [a, b, c] = [radar.sigma_range, radar.sigma_azimuth, radar.sigma_elevation];
            [a, b, c, radar.fov_azimuth, radar.fov_elevation]
        };
        assert_eq!(sigmas(found), sigmas(expected));
        assert_eq!(found.reliability, expected.reliability);
    }
    let [found, expected] = [found, expected].map(|rig| (&rig.lidars[0], &rig.cameras[0]));
    same_place(&found.0.vehicle_from_lidar, &expected.0.vehicle_from_lidar);
    assert_eq!((found.0.sigma_range, found.0.lowest_beam), (expected.0.sigma_range, expected.0.lowest_beam));
    same_place(&found.1.vehicle_from_camera, &expected.1.vehicle_from_camera);
    assert_eq!(found.1.intrinsics, expected.1.intrinsics);
}

/// From a velocity the reader derives a range rate, unless the settings say that the recording has none.
#[test]
fn the_way_there_and_back_adds_no_range_rate() {
    let (_dataset, path) = sequence();
    let toml = fs::read_to_string(path.join("sequence.toml")).unwrap();
    write(&path.join("sequence.toml"), toml.replace("\"doppler\", \"rcs\"", "\"vx\", \"vy\""));
    let reader = LayoutSequence::open(&path).unwrap();
    for format in [RosFormat::Mcap, RosFormat::Bag] {
        let folder = tempfile::tempdir().unwrap();
        let (recording, _) = converted(&reader, folder.path(), format);
        let again = &recording.sequences[0];
        let fields = ["x", "y", "z", "vx", "vy"];
        assert_eq!(again.sequence().rig.radars[0].fields, fields);
        // As text, for what is no number equals nothing.
        let columns = |source: &dyn Source| format!("{:?}", source.radar_scan(0, 0).unwrap().columns);
        assert_eq!(columns(again.as_ref()), columns(&reader));
        let path = folder.path().join("street").with_extension(format.extension());
        let guessed = open(&path, None).unwrap();
        assert_eq!(
            guessed.sequences[0].sequence().rig.radars[0].fields,
            [&fields[..], &["doppler"]].concat()
        );
    }
}

#[test]
fn the_way_there_and_back_keeps_what_both_can_hold() {
    for format in [RosFormat::Mcap, RosFormat::Bag] {
        let (folder, path) = sequence();
        let reader = LayoutSequence::open(&path).unwrap();
        let (recording, config) = converted(&reader, folder.path(), format);
        let back = recording.sequences[0].as_ref();
        let mut rig = back.sequence().rig.clone();
        config.method.apply_to(&mut rig, &[]).unwrap();
        same_rig(&rig, &reader.sequence().rig);
        assert_eq!(back.sequence().times, reader.sequence().times);
        assert_eq!(back.sequence().motion.odometry(), reader.sequence().motion.odometry());
        for image in 0..2 {
            let [found, expected] = [back.image(0, image), reader.image(0, image)].map(Result::unwrap);
            assert!(found == expected, "image {image}");
        }
        write_sequence(back, &folder.path().join("back"), &|_| {}).unwrap();
        let copy = folder.path().join("back/sequences/street");
        for (from, to) in [
            ("radar_front/000000.bin", "radar_front/000000.bin"),
            ("radar_front/000001.bin", "radar_front/000001.bin"),
            ("radar_front/000002.bin", "radar_front/000002.bin"),
            ("radar_front/timestamps.txt", "radar_front/timestamps.txt"),
            ("radar_rear/000003.bin", "radar_rear/000000.bin"),
            ("radar_rear/000010.bin", "radar_rear/000001.bin"),
            ("lidar_top/000000.bin", "lidar_top/000000.bin"),
            ("lidar_top/000001.bin", "lidar_top/000001.bin"),
            ("lidar_top/timestamps.txt", "lidar_top/timestamps.txt"),
            ("camera_front/timestamps.txt", "camera_front/timestamps.txt"),
            ("odometry.csv", "odometry.csv"),
        ] {
            assert!(fs::read(path.join(from)).unwrap() == fs::read(copy.join(to)).unwrap(), "{from}");
        }
        let [found, expected] = [back, &reader].map(|reader| reader.sequence().motion.poses().to_vec());
        assert_eq!(found.len(), expected.len());
        for (found, expected) in found.iter().zip(&expected) {
            assert_eq!(found.t_ns, expected.t_ns);
            same_place(&found.odom_from_vehicle, &expected.odom_from_vehicle);
        }
    }
}

#[test]
fn a_first_guess_finds_the_same_sensors() {
    let (folder, path) = sequence();
    let reader = LayoutSequence::open(&path).unwrap();
    converted(&reader, folder.path(), RosFormat::Mcap);
    let recording = open(&folder.path().join("street.mcap"), None).unwrap();
    let rig = &recording.sequences[0].sequence().rig;
    let names: Vec<&str> = rig.radars.iter().map(|radar| radar.name.as_str()).collect();
    assert_eq!(names, ["radar_front", "radar_rear"]);
    assert_eq!((rig.lidars[0].name.as_str(), rig.cameras[0].name.as_str()), ("lidar_top", "camera_front"));
}

/// Clocks that count from the begin of a recording have such times, and what moves is the same a second later.
#[test]
fn times_before_1970_are_put_off_by_whole_seconds_and_it_is_told() {
    for format in [RosFormat::Mcap, RosFormat::Bag] {
        let (folder, path) = sequence();
        write(&path.join("radar_rear/timestamps.txt"), "-1500000000\n30000000\n");
        let reader = LayoutSequence::open(&path).unwrap();
        let file = folder.path().join("street").with_extension(format.extension());
        let written = write_ros(&reader, &file, format, &|_| {}).unwrap();
        assert_eq!(written.delay_ns, 2_000_000_000);
        let config = fs::read_to_string(written.settings.unwrap()).unwrap();
        let config = Settings::from_toml(&config, &[]).unwrap();
        let recording = open_with(&file, None, &config.topics).unwrap();
        let [found, expected] = [recording.sequences[0].sequence(), reader.sequence()];
        let later = |t_ns: &i64| t_ns + 2_000_000_000;
        let all = |times: &[Vec<i64>]| {
            times.iter().map(|own| own.iter().map(later).collect()).collect::<Vec<Vec<_>>>()
        };
        assert_eq!(found.times.radars, all(&expected.times.radars));
        assert_eq!(found.times.lidars, all(&expected.times.lidars));
        assert_eq!(found.times.cameras, all(&expected.times.cameras));
        for (found, expected) in found.motion.poses().iter().zip(expected.motion.poses()) {
            assert_eq!(found.t_ns, later(&expected.t_ns));
            same_place(&found.odom_from_vehicle, &expected.odom_from_vehicle);
        }
    }
}

/// Poses and wheels that were measured at one time have the vehicle at one place.
#[test]
fn the_vehicle_is_shown_once_at_a_time() {
    let (folder, path) = sequence();
    let reader = LayoutSequence::open(&path).unwrap();
    converted(&reader, folder.path(), RosFormat::Mcap);
    let shown = messages(&folder.path().join("street.mcap"), |name| name == "/tf");
    let mut times: Vec<i64> = shown.iter().map(|(_, _, t_ns, _)| *t_ns).collect();
    let motion = &reader.sequence().motion;
    let measured = motion.poses().len() + motion.odometry().len();
    times.dedup();
    assert!(times.len() == shown.len() && times.len() < measured, "{} of {measured}", times.len());
}

/// ROS 2 takes no topic of which a part begins with a digit.
#[test]
fn a_name_that_begins_with_a_digit_is_read_back() {
    let (_dataset, path) = sequence();
    let toml = fs::read_to_string(path.join("sequence.toml")).unwrap();
    write(&path.join("sequence.toml"), toml.replace("\"radar_rear\"", "\"7 läft\""));
    fs::rename(path.join("radar_rear"), path.join("7 läft")).unwrap();
    let reader = LayoutSequence::open(&path).unwrap();
    let radar = |reader: &dyn SequenceReader| {
        let index = reader.sequence().rig.radars.iter().position(|radar| radar.name == "7 läft").unwrap();
        reader.radar_scan(index, 0).unwrap().columns
    };
    for format in [RosFormat::Mcap, RosFormat::Bag] {
        let folder = tempfile::tempdir().unwrap();
        let (recording, settings) = converted(&reader, folder.path(), format);
        assert_eq!(radar(recording.sequences[0].as_ref()), radar(&reader));
        let told = format!("{:?}", settings.topics);
        assert!(told.contains("\"/n7_l_ft/points\"") && !told.contains("\"/7"), "{told}");
    }
    write(
        &path.join("sequence.toml"),
        toml.replace("\"radar_rear\"", "\"7\"").replace("\"lidar_top\"", "\"n7\""),
    );
    for (from, to) in [("7 läft", "7"), ("lidar_top", "n7")] {
        fs::rename(path.join(from), path.join(to)).unwrap();
    }
    let file = tempfile::tempdir().unwrap().path().join("street.mcap");
    let told = write_ros(&LayoutSequence::open(&path).unwrap(), &file, RosFormat::Mcap, &|_| {}).unwrap_err();
    assert!(told.to_string().contains("two topics of the name `n7`"), "{told}");
}

#[test]
fn what_ros_can_not_hold_is_refused_and_nothing_stays() {
    let (folder, path) = sequence();
    // Beyond 2106 there are no 32 bits for the seconds.
    write(&path.join("radar_rear/timestamps.txt"), "7\n4500000000000000000\n");
    let reader = LayoutSequence::open(&path).unwrap();
    let file = folder.path().join("street.bag");
    let error = write_ros(&reader, &file, RosFormat::Bag, &|_| {}).unwrap_err().to_string();
    assert!(error.contains("2^32 - 1 s") || error.contains("from 1970 to 2106"), "{error}");
    let names: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names, ["sequences"]);
}

/// Every message of a recording, in the order of topics and times.
fn messages(file: &Path, keep: impl Fn(&str) -> bool) -> Vec<(String, String, i64, Vec<u8>)> {
    let container = Container::open(file).unwrap();
    let mut all: Vec<_> = container
        .messages()
        .iter()
        .filter_map(|message| {
            let topic = &container.topics()[container.topic_of(message)];
            let bytes = || container.read(message).unwrap();
            keep(&topic.name).then(|| (topic.name.clone(), topic.type_name.clone(), message.log_ns, bytes()))
        })
        .collect();
    all.sort();
    all
}

#[test]
fn original_messages_are_copied_beside_the_labelled_clouds() {
    let Ok(data) = std::env::var("RALF_TEST_DATA") else {
        return println!("skipped: RALF_TEST_DATA is not set");
    };
    for (name, format, kind) in
        [("nuscenes-0061-zstd.mcap", "mcap", "mcap"), ("nuscenes-0061-lz4.bag", "rosbag1", "bag")]
    {
        let file = Path::new(&data).join("ros").join(name);
        let folder = tempfile::tempdir().unwrap();
        let recording = open(&file, None).unwrap();
        let settings = Settings::default();
        let out = folder.path().join("out");
        LabelRun {
            recording: &recording,
            settings: &settings,
            out: &out,
            jobs: 2,
            evidence: false,
            checks: &[],
            model: None,
        }
        .execute(&Unwatched)
        .unwrap();
        let format = ExportFormat::named(format).unwrap();
        let options = ExportOptions { format, split: Split::All, sensors: Sensors::ALL, replace: false };
        let labelled = folder.path().join("labelled").with_extension(kind);
        let exported =
            Export { recording: &recording, out: &out, options }.write(&labelled, &|_| {}).unwrap();
        assert_eq!(exported.scans, 654);
        let is_labelled = |name: &str| name.ends_with("/points_labelled");
        let copied = messages(&labelled, |name| !is_labelled(name));
        assert_eq!(copied.len(), 1156);
        assert!(copied == messages(&file, |_| true), "{name}");
        let of_labels = messages(&labelled, is_labelled);
        assert_eq!(of_labels.len(), 654);
        // Each stands beside the cloud that it labels, whatever the radar's own clock says.
        let logged: BTreeSet<(&str, i64)> =
            copied.iter().map(|(topic, _, log_ns, _)| (topic.as_str(), *log_ns)).collect();
        let is_beside = |(topic, _, log_ns, _): &(String, String, i64, Vec<u8>)| {
            logged.contains(&(topic.trim_end_matches("_labelled"), *log_ns))
        };
        assert!(of_labels.iter().all(is_beside), "{name}");
    }
}
