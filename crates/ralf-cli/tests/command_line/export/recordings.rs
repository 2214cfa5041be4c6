//! MCAP files and bags.

use super::{BRANCHES, Found, export, found, labelled, list, recorded, run};
use crate::support::{Dataset, Row, Shape, ralf, read_export, rows};
use serde_json::{Value, json};

fn with_camera() -> Dataset {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() }).with_camera(2);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

/// The rows of a topic of a radar.
fn of_topic<'a>(read: &'a Value, sensor: &str, topic: &str) -> Vec<&'a Value> {
    list(read).iter().filter(|row| row["sensor"] == sensor && row["topic"] == topic).collect()
}

fn of_radar(dataset: &Dataset, radar: &str) -> Vec<Found> {
    found(dataset, "00").into_iter().filter(|found| found.radar == radar).collect()
}

const KINDS: [(&str, &str); 2] = [("mcap", "recording.mcap"), ("rosbag1", "recording.bag")];

#[test]
fn labelled_clouds_hold_fields_and_answers() {
    let dataset = labelled(&Shape { scans: 3, ..Shape::default() });
    for (format, name) in KINDS {
        let Some(read) = read_export(format, &export(&dataset, format, name, &[])) else { return };
        let topics: Vec<&String> = read["topics"].as_object().unwrap().keys().collect();
        assert_eq!(topics, ["/radar_front/points_labelled", "/radar_left/points_labelled", "/tf_static"]);
        for radar in ["radar_front", "radar_left"] {
            let (rows, expected) = (of_topic(&read, radar, "points_labelled"), of_radar(&dataset, radar));
            assert_eq!(rows.len(), expected.len());
            for (row, found) in rows.into_iter().zip(expected) {
                assert_eq!(row["t_ns"], found.t_ns);
                assert_eq!(
                    [row["label"].as_i64(), row["flags"].as_i64()],
                    [found.label, found.flags].map(Some)
                );
                assert_eq!(row["plausibility"].as_f64(), found.w);
                let colour = match found.label {
                    0 => 0x8b96_a5ff,
                    1 => 0xf080_3cff_u32,
                    _ => 0x4ba8_eaff,
                };
                assert_eq!(row["colors"], colour);
                assert_eq!(BRANCHES.map(|name| row[name].as_f64()), found.branches);
                let value = |name: &str| row[name].as_f64().unwrap();
                if radar == "radar_front" {
                    let measured = &recorded(&dataset, radar, found.scan, 5)[found.point as usize];
                    assert_eq!(["x", "y", "z", "doppler", "rcs"].map(value), measured[..]);
                } else {
                    let measured = &recorded(&dataset, radar, found.scan, 3)[found.point as usize];
                    assert_eq!(["range", "azimuth", "doppler"].map(value), measured[..]);
                    assert!((value("x").hypot(value("y")) - measured[0]).abs() < 1e-5);
                }
            }
        }
        assert_eq!(read["frames"]["/radar_left/points_labelled"], "radar_left");
        assert_eq!(read["mounted"]["radar_front"], json!(["base_link", [3.6, 0.0, 0.5, 0.0, 0.0, 0.0, 1.0]]));
        assert_eq!(read["types"]["points_labelled/label"], "uint32");
        assert_eq!(read["types"]["points_labelled/colors"], "uint32");
    }
}

#[test]
fn a_field_of_the_radar_that_has_the_name_of_one_of_the_export_is_refused() {
    for name in ["colors", "plausibility"] {
        let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() });
        let sensors = std::fs::read_to_string(dataset.file("sequence.toml")).unwrap();
        dataset.put("sequence.toml", sensors.replace("\"rcs\"", &format!("\"{name}\"")));
        ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
        for (format, path) in KINDS {
            let path = dataset.beside(path);
            let found = format!("that the export adds, found `{name}`");
            run(&dataset, format, &path, &[]).exits(1).says(["00: radar_front: expected", &found]);
            assert!(!std::path::Path::new(&path).exists());
        }
        // Clouds of PCD files have no colours of labels, so that the radar's own are in nobody's way.
        if name == "colors" {
            export(&dataset, "pcd", "clouds", &[]);
        }
    }
}

#[test]
fn with_the_sensors_data_it_is_the_whole_recording() {
    let dataset = with_camera();
    for (format, name) in KINDS {
        let path = export(&dataset, format, name, &["--sensors"]);
        let Some(read) = read_export(format, &path) else { return };
        let kind = |kind: &str, count: usize| json!([kind, count]);
        let topics = read["topics"].as_object().unwrap();
        let cloud = "sensor_msgs/msg/PointCloud2";
        for (topic, expected) in [
            ("/camera_front/camera_info", kind("sensor_msgs/msg/CameraInfo", 2)),
            ("/camera_front/image_raw/compressed", kind("sensor_msgs/msg/CompressedImage", 2)),
            ("/lidar_top/points", kind(cloud, 3)),
            ("/radar_front/points", kind(cloud, 3)),
            ("/radar_front/points_labelled", kind(cloud, 3)),
            ("/radar_left/points", kind(cloud, 3)),
            ("/radar_left/points_labelled", kind(cloud, 3)),
        ] {
            assert_eq!(topics[topic], expected, "{topic}");
        }
        for (sensor, columns, names) in [
            ("radar_front", 5, ["x", "y", "z", "doppler", "rcs"].as_slice()),
            ("radar_left", 3, &["range", "azimuth", "doppler"]),
            ("lidar_top", 4, &["x", "y", "z", "intensity"]),
        ] {
            let rows = of_topic(&read, sensor, "points");
            let expected = (0..3).flat_map(|scan| recorded(&dataset, sensor, scan, columns));
            assert_eq!(rows.len(), expected.clone().count());
            for (row, measured) in rows.into_iter().zip(expected) {
                assert_eq!(
                    names.iter().map(|name| row[name].as_f64().unwrap()).collect::<Vec<_>>(),
                    measured
                );
            }
        }
        let image = std::fs::read(dataset.file("camera_front/000001.png")).unwrap();
        let sum = image.iter().map(|byte| u64::from(*byte)).sum::<u64>();
        let t_ns = 1_700_000_000_110_000_000_u64;
        assert_eq!(read["images"]["camera_front"][1], json!([t_ns, "png", image.len(), sum]));
        let calibration = json!([
            "plumb_bob",
            160,
            120,
            [80.0, 0.0, 79.5, 0.0, 80.0, 59.5, 0.0, 0.0, 1.0],
            [0.0, 0.0, 0.0, 0.0, 0.0]
        ]);
        assert_eq!(read["calibrations"]["camera_front"], calibration);
        assert!(read["twists"].as_array().unwrap().iter().all(|sample| sample[1] == 5.0 && sample[2] == 0.0));
    }
}

#[test]
fn a_recording_is_converted_without_labels() {
    let dataset = with_camera();
    for (format, name) in KINDS {
        let path = dataset.beside(name);
        ralf(["convert", &dataset.path, "-o", &path]).exits(0).prints_nothing().says([&path]);
        ralf(["convert", &dataset.path, "-o", &path]).exits(1).says([name, "none of this name yet"]);
        assert!(std::fs::exists(dataset.beside("recording.toml")).unwrap());
        std::fs::remove_file(dataset.beside("recording.toml")).unwrap();
        let Some(read) = read_export(format, &path) else { return };
        assert!(read["topics"].as_object().unwrap().keys().all(|topic| !topic.contains("labelled")));
        assert_eq!(of_topic(&read, "radar_left", "points").len(), of_radar(&dataset, "radar_left").len());
    }
}

/// The settings beside it make up for what ROS has no place for.
#[test]
fn a_converted_recording_is_labelled_the_same_and_copied_beside_its_labels() {
    let dataset = labelled(&Shape { scans: 3, ..Shape::default() });
    let [file, settings, out] = ["street.mcap", "street.toml", "street-out"].map(|name| dataset.beside(name));
    ralf(["convert", &dataset.path, "-o", &file]).exits(0).says([&settings]);
    ralf(["label", &file, "-o", &out, "--config", &settings]).exits(0);
    let [found, expected] = [format!("{out}/sequences/street"), format!("{}/sequences/00", dataset.out)]
        .map(|folder| rows(format!("{folder}/plausibility.parquet")));
    assert_eq!(found.len(), expected.len());
    for (found, expected) in found.iter().zip(&expected) {
        let place =
            |row: &Row| (row.radar().to_owned(), row.whole("scan"), row.whole("point"), row.whole("t_ns"));
        assert_eq!(place(found), place(expected));
        assert_eq!(found.whole("label"), expected.whole("label"));
        assert!((found.decimal("w").unwrap() - expected.decimal("w").unwrap()).abs() < 1e-5);
    }
    let path = dataset.beside("labelled.mcap");
    ralf(["export", &file, &out, "--to", "mcap", "--sensors", "-o", &path]).exits(0);
    let [Some(before), Some(after)] = [&file, &path].map(|file| read_export("mcap", file)) else { return };
    for (topic, kind) in before["topics"].as_object().unwrap() {
        assert_eq!(after["topics"][topic], *kind, "{topic}");
    }
    let of = |read: &Value, topic| of_topic(read, "radar_left", topic).len();
    assert_eq!(of(&after, "points_labelled"), of(&before, "points"));
    assert_eq!(after["frames"]["/radar_left/points_labelled"], after["frames"]["/radar_left/points"]);
}

/// Motion from before the first scan, of a clock that counts from there.
#[test]
fn times_before_1970_are_put_off_with_a_warning() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() });
    let odometry = std::fs::read_to_string(dataset.file("odometry.csv")).unwrap();
    dataset.put("odometry.csv", odometry.replacen('\n', "\n-200000000,0,0\n", 1));
    ralf(["label", &dataset.path, "-o", &dataset.out, "--no-check"]).exits(0);
    let warning = "all times are 1 second later than in the recording, for some are before 1970";
    for (format, name) in KINDS {
        let labels = run(&dataset, format, &dataset.beside(&format!("labels-{name}")), &[]).exits(0);
        assert!(!labels.stderr.contains("warning"), "{}", labels.stderr);
        let path = dataset.beside(name);
        run(&dataset, format, &path, &["--sensors"]).exits(0).says(["warning: 00:", warning]);
        let Some(read) = read_export(format, &path) else { return };
        let times =
            of_topic(&read, "radar_left", "points_labelled").into_iter().map(|row| row["t_ns"].as_i64());
        let expected =
            of_radar(&dataset, "radar_left").into_iter().map(|found| Some(found.t_ns + 1_000_000_000));
        assert!(times.eq(expected), "{format}");
        let copy = dataset.beside(&format!("copy-{name}"));
        ralf(["convert", &dataset.path, "-o", &copy]).exits(0).says(["warning: ", warning]);
    }
}
