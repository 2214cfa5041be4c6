//! ROS recordings: from a first look to labels. The small files are of other programs (`testdata/make_ros.py`).

use crate::support::{Dataset, ROS_TOPICS, ralf, rows, tree};
use std::fs;
use std::path::Path;

fn fixture(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/ros");
    folder.join(name).to_str().unwrap().to_owned()
}

fn beside(folder: &tempfile::TempDir, name: &str) -> String {
    folder.path().join(name).to_str().unwrap().to_owned()
}

#[test]
fn a_camera_whose_frame_nobody_tells_is_left_out() {
    for name in ["plain.bag", "zstd.mcap", "db3"] {
        let ran = ralf(["inspect", &fixture(name)]).exits(0);
        let ran = ran.prints([
            "/radar/points",
            "sensor_msgs/",
            "PointCloud2",
            "[topics.radar]",
            "kind = \"radar\"",
        ]);
        ran.prints(["# /imu is not used: /odom tells the motion", "13.0 Hz"])
            .says(["the camera cam is left out", "no frame `cam`"]);
    }
}

#[test]
fn topics_of_what_is_no_ros_recording_are_told_to_be_idle() {
    let dataset = Dataset::new();
    let file = dataset.beside("topics.toml");
    fs::write(&file, "[topics]\ntf = { topic = '/tf', kind = 'tf' }\n").unwrap();
    ralf(["inspect", &dataset.path, "--quick", "--topics", &file])
        .exits(0)
        .says(["topics.toml is not used: ", "is no ROS recording"]);
}

#[test]
fn a_guess_is_written_once_and_never_over_another_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = beside(&folder, "ralf.toml");
    ralf(["inspect", &fixture("lz4.bag"), "--write-topics", &file]).exits(0).says([file.as_str()]);
    let written = fs::read_to_string(&file).unwrap();
    assert!(written.contains("[topics.cam]\ntopic = \"/cam/image_raw\"\nkind = \"camera\""), "{written}");
    fs::write(&file, "# mine").unwrap();
    ralf(["inspect", &fixture("lz4.bag"), "--write-topics", &file]).exits(2).says(["is there already"]);
    assert_eq!(fs::read_to_string(&file).unwrap(), "# mine");
    let here = folder.path().to_str().unwrap();
    ralf(["inspect", here, "--write-topics", &beside(&folder, "new.toml")])
        .exits(2)
        .says(["a ROS recording"]);
}

#[test]
fn every_container_is_labelled_to_the_same_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let table = beside(&folder, "ralf.toml");
    fs::write(&table, ROS_TOPICS).unwrap();
    let mut labels = Vec::new();
    for name in ["plain.bag", "bz2.bag", "lz4.mcap", "ros1.mcap", "db3"] {
        let out = beside(&folder, name);
        ralf(["label", &fixture(name), "-o", &out, "--config", &table, "-q"]).exits(0).says_nothing();
        let run = fs::read_to_string(Path::new(&out).join("run.json")).unwrap();
        assert!(run.contains("/radar/points"), "the topics are among the settings: {run}");
        let sequence = name.split('.').next().unwrap();
        let scans = Path::new(&out).join("sequences").join(sequence).join("radar");
        labels.push(
            (0..3).map(|scan| fs::read(scans.join(format!("{scan:06}.label"))).unwrap()).collect::<Vec<_>>(),
        );
        // The other commands are told by a file of its own.
        let picture = beside(&folder, "scan.png");
        let plot = ["plot", &fixture(name), &out, "--scan", "1", "-o", &picture, "--topics", &table];
        ralf(plot).exits(0);
    }
    assert!(labels.windows(2).all(|pair| pair[0] == pair[1]));
    assert!(labels[0].iter().all(|scan| scan.len() == 8), "two detections of four bytes each");
}

#[test]
fn a_table_that_asks_for_what_is_not_there_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let table = beside(&folder, "ralf.toml");
    for (text, told) in [
        (
            ROS_TOPICS.replace("/odom", "/nowhere"),
            "topics.odom: expected one of the topics of the type nav_msgs/Odometry: /odom, found `/nowhere`",
        ),
        (ROS_TOPICS.replace("ars408-21", "ars"), "expected one of the models generic"),
        (ROS_TOPICS.replace("kind = 'odometry'", "kind = 'odometer'"), "odometer"),
        (ROS_TOPICS.replace("model =", "modell ="), "modell"),
    ] {
        fs::write(&table, text).unwrap();
        let out = beside(&folder, "out");
        ralf(["label", &fixture("plain.mcap"), "-o", &out, "--config", &table]).exits(1).says([told]);
    }
}

#[test]
fn a_topic_of_a_type_that_no_topic_has() {
    let dataset = Dataset::new();
    let [file, settings] = ["drive.mcap", "drive.toml"].map(|name| dataset.beside(name));
    ralf(["convert", &dataset.path, "-o", &file, "-q"]).exits(0);
    let text = fs::read_to_string(&settings).unwrap();
    fs::write(&settings, text + "\n[topics.gyro]\ntopic = '/gyro'\nkind = 'imu'\n").unwrap();
    let told =
        "topics.gyro: expected a topic of the type sensor_msgs/Imu, of which there is none, found `/gyro`";
    ralf(["label", &file, "-o", &dataset.out, "--config", &settings]).exits(1).ends_with_error([told]);
}

/// A radar that was off: its topic is there, and nothing in it.
#[test]
fn a_sensor_without_measurements_is_read_back() {
    let dataset = Dataset::new();
    for sensor in ["radar_left", "lidar_top"] {
        fs::remove_dir_all(dataset.file(sensor)).unwrap();
        fs::create_dir(dataset.file(sensor)).unwrap();
        dataset.put(&format!("{sensor}/timestamps.txt"), "");
    }
    fs::remove_dir_all(dataset.file("ground_truth/radar_left")).unwrap();
    for ending in ["bag", "mcap"] {
        let [file, out, again] =
            ["", "out_", "own_"].map(|what| dataset.beside(&format!("{what}drive.{ending}")));
        let settings = dataset.beside("drive.toml");
        ralf(["convert", &dataset.path, "-o", &file, "-q"]).exits(0);
        ralf(["label", &file, "-o", &out, "--config", &settings, "--no-check"]).exits(0).says([
            "radar_left: no messages of /radar_left/points",
            "lidar_top: no messages of /lidar_top/points",
        ]);
        let table = Path::new(&out).join("sequences/drive/plausibility.parquet");
        assert!(rows(table).iter().all(|row| row.radar() == "radar_front"));
        let again = again.replace('.', "_");
        ralf(["convert", &file, "-o", &again, "--config", &settings, "-q"]).exits(0);
        let toml = fs::read_to_string(Path::new(&again).join("sequences/drive/sequence.toml")).unwrap();
        assert!(toml.contains("name = \"radar_left\"") && toml.contains("name = \"lidar_top\""), "{toml}");
        fs::remove_file(settings).unwrap();
    }
}

/// What the settings alter is not copied from the messages as they are, neither as a recording nor beside labels.
#[test]
fn what_is_corrected_is_written_so_to_the_same_kind() {
    let dataset = Dataset::new();
    let place = |name: &str| dataset.beside(name);
    let corrections = "\n[corrections.radar_front]\nadd_yaw_deg = 5.0\ntime_offset_ms = 40.0\ndoppler_factor = 2.0\n\
                       \n[corrections.lidar_top]\nadd_translation = [0.0, 0.0, 0.5]\n\n[motion]\nspeed_factor = 1.5\n";
    for (ending, format) in [("mcap", "mcap"), ("bag", "rosbag1")] {
        let at = |name: &str| place(&format!("{ending}-{name}.{ending}"));
        let [drive, fixed, labelled, copy] = ["drive", "fixed", "labelled", "copy"].map(at);
        let [topics, fixes, out] =
            ["drive.toml", "fixes.toml", "out"].map(|name| place(&format!("{ending}-{name}")));
        ralf(["convert", &dataset.path, "-o", &drive, "-q"]).exits(0);
        fs::write(&fixes, fs::read_to_string(&topics).unwrap() + corrections).unwrap();
        ralf(["convert", &drive, "--config", &fixes, "-o", &fixed, "-q"]).exits(0);
        ralf(["label", &drive, "--config", &fixes, "-o", &out, "--no-check", "-q"]).exits(0);
        ralf(["export", &drive, &out, "--to", format, "--sensors", "-o", &labelled, "-q"]).exits(0);
        ralf(["convert", &drive, "--topics", &topics, "-o", &copy, "-q"]).exits(0);
        assert!(!fs::exists(place(&format!("{ending}-copy.toml"))).unwrap(), "those of the original hold");
        // Each as it is then read, without its corrections.
        let read = |file: &str, settings: &str| {
            let own = format!("{file}-read");
            ralf(["convert", file, "--config", settings, "-o", &own, "-q"]).exits(0);
            let sequence = Path::new(file).file_stem().unwrap().to_str().unwrap();
            let mut read = tree(format!("{own}/sequences/{sequence}"));
            let toml = String::from_utf8(read.remove("sequence.toml").flatten().unwrap()).unwrap();
            // The first lines tell how many topics there are.
            (read, toml.split_once("[[radar]]").unwrap().1.to_owned())
        };
        let expected = read(&drive, &fixes);
        assert!(expected != read(&copy, &topics));
        assert!(read(&fixed, &place(&format!("{ending}-fixed.toml"))) == expected, "{ending}");
        assert!(read(&labelled, &topics) == expected, "{format}");
    }
}
