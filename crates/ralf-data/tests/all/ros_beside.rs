//! What lies beside a recording as a ROS file: its settings, and what it is while it is written.

use crate::dataset::write;
use crate::export_ros::sequence;
use ralf_data::write::export::{RosFormat, write_ros};
use ralf_data::{LayoutSequence, Settings, open_with};
use std::fs;
use std::path::Path;

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| name != "sequences")
        .collect();
    names.sort();
    names
}

/// One begins and ends while the other is at work.
#[test]
fn two_conversions_of_one_name_at_once_have_settings_of_their_own() {
    let (folder, path) = sequence();
    let reader = LayoutSequence::open(&path).unwrap();
    let [mcap, bag] = ["street.mcap", "street.bag"].map(|name| folder.path().join(name));
    let whole = |done| {
        if done == 1 {
            let within = write_ros(&reader, &bag, RosFormat::Bag, &|_| {}).unwrap();
            assert_eq!(within.settings.unwrap(), folder.path().join("street.toml"));
        }
    };
    let written = write_ros(&reader, &mcap, RosFormat::Mcap, &whole).unwrap();
    assert_eq!(written.settings.unwrap(), folder.path().join("street.mcap.toml"));
    assert_eq!(names(folder.path()), ["street.bag", "street.mcap", "street.mcap.toml", "street.toml"]);
}

#[test]
fn settings_that_somebody_writes_meanwhile_are_not_overwritten() {
    let (folder, path) = sequence();
    let reader = LayoutSequence::open(&path).unwrap();
    let [file, mine, other] =
        ["street.bag", "street.toml", "street.bag.toml"].map(|name| folder.path().join(name));
    let whole = |_| fs::write(&mine, "mine").unwrap();
    let written = write_ros(&reader, &file, RosFormat::Bag, &whole).unwrap();
    assert_eq!((written.settings.as_ref(), fs::read(&mine).unwrap()), (Some(&other), b"mine".to_vec()));
    fs::remove_file(&file).unwrap();
    fs::remove_file(&other).unwrap();
    let both = |_| [&mine, &other].into_iter().for_each(|file| fs::write(file, "mine").unwrap());
    let error = write_ros(&reader, &file, RosFormat::Bag, &both).unwrap_err().to_string();
    assert!(error.contains("street.bag.toml: file: expected none of this name yet"), "{error}");
    assert_eq!(names(folder.path()), ["street.bag.toml", "street.toml"]);
}

#[cfg(unix)]
#[test]
fn a_recording_is_never_written_through_a_link() {
    let (folder, path) = sequence();
    let reader = LayoutSequence::open(&path).unwrap();
    // What browsers call what they have not downloaded yet is somebody's own.
    let own = folder.path().join("street.mcap.part");
    fs::write(&own, "mine").unwrap();
    let [file, part, victim] =
        ["street.mcap", ".street.mcap.part", "victim"].map(|name| folder.path().join(name));
    fs::write(&victim, "mine").unwrap();
    std::os::unix::fs::symlink(&victim, &part).unwrap();
    write_ros(&reader, &file, RosFormat::Mcap, &|_| {}).unwrap();
    let written = fs::read(&file).unwrap();
    assert!(fs::read(&victim).unwrap() == b"mine" && !file.is_symlink());
    // What a kill left is taken over, however long it is.
    fs::remove_file(&file).unwrap();
    fs::write(&part, vec![7; 2 * written.len()]).unwrap();
    write_ros(&reader, &file, RosFormat::Mcap, &|_| {}).unwrap();
    assert!(fs::read(&file).unwrap() == written);
    assert_eq!(names(folder.path()), ["street.mcap", "street.mcap.part", "street.toml", "victim"]);
    assert_eq!(fs::read(&own).unwrap(), b"mine");
}

#[test]
fn settings_read_back_what_they_lie_beside() {
    let (folder, path) = sequence();
    // Names that topics of the motion have, and then no motion.
    let toml = fs::read_to_string(path.join("sequence.toml")).unwrap();
    write(
        &path.join("sequence.toml"),
        toml.replace("radar_front", "twist").replace("radar_rear", "tf_static"),
    );
    for (from, to) in [("radar_front", "twist"), ("radar_rear", "tf_static")] {
        fs::rename(path.join(from), path.join(to)).unwrap();
    }
    fs::remove_file(path.join("lidar_top/000000.time")).unwrap();
    for (has_motion, name) in [(true, "moving.mcap"), (false, "still.mcap")] {
        if !has_motion {
            ["odometry.csv", "poses.csv"].iter().for_each(|name| fs::remove_file(path.join(name)).unwrap());
        }
        let reader = LayoutSequence::open(&path).unwrap();
        let file = folder.path().join(name);
        let settings = write_ros(&reader, &file, RosFormat::Mcap, &|_| {}).unwrap().settings.unwrap();
        let settings = Settings::from_toml(&fs::read_to_string(settings).unwrap(), &[]).unwrap();
        let recording = open_with(&file, None, &settings.topics).unwrap();
        let found = recording.sequences[0].as_ref();
        let radars: Vec<&str> = found.sequence().rig.radars.iter().map(|radar| radar.name.as_str()).collect();
        assert_eq!((radars, found.sequence().motion.is_known()), (vec!["tf_static", "twist"], has_motion));
        assert_eq!(found.radar_scan(1, 2).unwrap().columns[3], [-3.5]);
    }
}
