//! Small whole recordings, runs, networks and settings, to be damaged.

#[allow(dead_code, reason = "the tests of the reader use all of it")]
#[path = "../../ralf-data/src/read/aimotive/tests/recording.rs"]
mod aimotive;
#[allow(dead_code, reason = "the tests of the command line use all of it")]
#[path = "../../ralf-cli/tests/command_line/support/dataset.rs"]
mod dataset;
#[path = "../../ralf-cli/tests/command_line/support/foreign.rs"]
mod foreign;
#[allow(dead_code, reason = "the tests of the reader use all of it")]
#[path = "../../ralf-data/src/disk/hdf5/writing.rs"]
mod hdf5;
#[allow(dead_code, reason = "the tests of the crate use all of it")]
#[path = "../../ralf-depth/src/testing.rs"]
mod network;
#[allow(dead_code, reason = "the tests of the reader use all of it")]
#[path = "../../ralf-data/src/read/nvidia/tests/recording.rs"]
mod nvidia;
#[allow(dead_code, reason = "the tests of the reader use all of it")]
#[path = "../../ralf-data/src/read/radar_ghost/tests/recording.rs"]
mod radar_ghost;
#[allow(dead_code, reason = "the tests of the reader use all of it")]
#[path = "../../ralf-data/src/read/radar_scenes/tests/recording.rs"]
mod radar_scenes;
#[path = "../../ralf-cli/tests/command_line/support/ros_topics.rs"]
mod ros_topics;
#[allow(dead_code, reason = "the tests of the reader use all of it")]
#[path = "../../ralf-data/src/read/truckscenes/tests/recording.rs"]
mod truckscenes;
#[allow(dead_code, reason = "the tests of the command line use all of it")]
#[path = "../../ralf-cli/tests/command_line/support/world.rs"]
mod world;
#[allow(dead_code, reason = "the tests of the reader use all of it")]
#[path = "../../ralf-data/src/read/zod/tests/recording.rs"]
mod zod;

use crate::tree::copy;
use crate::verbs::label;
use ralf::config::Config;
use ralf::sensors::{CameraImage, ClassImage, DepthImage, DepthOutput};
use ralf_corrections::{Mark, ScanKey, Who};
use ralf_data::Settings;
use ralf_data::views::{DepthStore, SegmentationStore, Store, StoredView};
use std::fs;
use std::path::Path;

/// What the recordings in `testdata/ros` have besides.
const FURTHER_TOPICS: &str = "
[topics.imu]
topic = '/imu'
kind = 'imu'
frame = 'base_link'
[topics.cam]
topic = '/cam/image_raw'
kind = 'camera'
info = '/cam/camera_info'
frame = 'radar'
";
/// Of the own recording's camera.
const IMAGES: usize = 2;
const ROS: [&str; 4] = ["plain.bag", "lz4.bag", "zstd.mcap", "lz4.mcap"];
const CARD: &str = "input = { size = 16, multiple_of = 4, side = \"short\" }\nfit = \"stretch\"\nchannels = \"rgb\"\n\
    divide_by = 255\nmean = [0, 0, 0]\nstd = [1, 1, 1]\noutput = \"disparity\"\nflip = true\n";

/// Makes all places in a folder, one in each.
pub fn make_places(folder: &Path) {
    let own = own_recording();
    copy(Path::new(&own.path), &folder.join("own/recording"));
    foreign::nuscenes(&folder.join("nuscenes/recording"));
    foreign::view_of_delft(&folder.join("view-of-delft/recording"));
    aimotive::write_sequence(&folder.join("aimotive/recording").join(aimotive::SEQUENCE));
    truckscenes::write_data_set(&folder.join("truckscenes/recording"), &truckscenes::TINY);
    zod::write_data_set(&folder.join("zod/recording"));
    radar_ghost::write_dataset(&folder.join("radar-ghost/recording"));
    radar_scenes::write_dataset(&folder.join("radarscenes/recording"));
    nvidia::write_unzipped(&folder.join("nvidia/recording"));
    let ros = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/ros");
    let topics = format!("{}{FURTHER_TOPICS}", ros_topics::ROS_TOPICS);
    for name in ROS {
        let place = folder.join(name);
        put(&place.join("topics.toml"), &topics);
        fs::copy(ros.join(name), place.join("recording")).unwrap();
    }
    for name in ["db3", "db3_zstd", "folder"] {
        copy(&ros.join(name), &folder.join(name).join("recording"));
        put(&folder.join(name).join("topics.toml"), &topics);
    }
    make_run(Path::new(&own.path), &folder.join("run"));
    make_depth(Path::new(&own.path), &folder.join("depth"));
    make_classes(Path::new(&own.path), &folder.join("classes"));
    let tiny = network::channel_sum([0.5, 0.25, 0.125]);
    put(&folder.join("network/net.onnx"), tiny);
    put(&folder.join("network/net.toml"), CARD);
    copy(Path::new(&own.path), &folder.join("settings/recording"));
    put(&folder.join("settings/file/ralf.toml"), Config::default().to_toml().unwrap());
    let scenario = ralf_sim::presets::find("tiny").unwrap().sequences[0].text();
    put(&folder.join("scenario/scenario.toml"), scenario);
}

fn own_recording() -> dataset::Dataset {
    let shape = dataset::Shape { scans: 3, classes: true, ..dataset::Shape::default() };
    let made = dataset::Dataset::of(&shape).with_camera(IMAGES);
    segment(Path::new(&made.path), Path::new(&made.path));
    made
}

/// A recording with what `ralf label` made of it, and corrections of a scan.
fn make_run(recording: &Path, place: &Path) {
    copy(recording, &place.join("recording"));
    let opened = ralf_data::open(&place.join("recording"), None).unwrap();
    let out = place.join("out");
    label(&opened, &Settings::default(), &out).unwrap();
    let labels = fs::read(out.join("sequences/00/radar_front/000000.label")).unwrap();
    let machine = labels.as_chunks::<4>().0.iter().map(|[low, high, ..]| u16::from_le_bytes([*low, *high]));
    let key = ScanKey { sequence: "00".into(), radar: "radar_front".into(), scan: 0 };
    let mark = Mark { key, content: None, base: 0, machine: machine.collect(), reviewed: true };
    let mut store = ralf_corrections::Store::open(&out.join("corrections.sqlite")).unwrap();
    store.mark(&mark, &Who::named("ada")).unwrap();
}

/// A recording with a store of depth images beside it.
fn make_depth(recording: &Path, place: &Path) {
    copy(recording, &place.join("recording"));
    let store = DepthStore::create(&place.join("depth"), DepthOutput::Depth, "net").unwrap();
    fill(&store, recording, |CameraImage { width, height, .. }| DepthImage {
        width: *width,
        height: *height,
        values: vec![10.0; width * height],
    });
    assert!(DepthStore::open(&place.join("depth")).is_ok());
}

/// A recording with a store of segmentations beside it.
fn make_classes(recording: &Path, place: &Path) {
    copy(recording, &place.join("recording"));
    segment(recording, &place.join("classes"));
}

/// Stores what a network says of a recording's images to which everything is a car.
fn segment(recording: &Path, root: &Path) {
    let store = SegmentationStore::create(root, "net").unwrap();
    fill(&store, recording, |CameraImage { width, height, .. }| ClassImage {
        width: *width,
        height: *height,
        ids: vec![10; width * height],
    });
}

/// Stores what a network says of the images of a recording's camera.
fn fill<V: StoredView>(store: &Store<V>, recording: &Path, says: impl Fn(&CameraImage) -> V + Sync) {
    let recording = ralf_data::open(recording, None).unwrap();
    let images: Vec<_> = (0..IMAGES).map(|image| (0, image)).collect();
    let reader = recording.sequences[0].as_ref();
    let estimate = |view: &CameraImage, _: f64| Ok(says(view));
    assert!(store.compute(reader, &images, &estimate, 1, &|| ()).unwrap().without.is_empty());
}

fn put(file: &Path, content: impl AsRef<[u8]>) {
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, content).unwrap();
}
