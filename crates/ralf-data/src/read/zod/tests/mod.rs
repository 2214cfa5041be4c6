//! A small sequence in the genuine layout, made here.

mod recording;

use super::*;
use crate::read::SequenceReader;
use crate::testing;
use ralf::sensors::{Intrinsics, is_return};
use ralf::space::Point;
use recording::{DETECTIONS, FOLDER, LIST, POSTS, T0, ego_from_lidar, npy, start_from_ego, write_data_set};
use serde_json::{Value, json};
use std::fs;
use tempfile::TempDir;

struct DataSet(TempDir);

impl DataSet {
    fn new() -> Self {
        let set = Self(tempfile::tempdir().unwrap());
        write_data_set(set.0.path());
        set
    }

    fn edit(&self, name: &str, change: impl FnOnce(&mut Value)) {
        let file = self.0.path().join(name);
        let mut value = serde_json::from_str(&fs::read_to_string(&file).unwrap()).unwrap();
        change(&mut value);
        testing::write(&file, value.to_string().as_bytes());
    }

    fn open(&self) -> Result<Box<dyn SequenceReader>, DataError> {
        let mut recording = crate::read::open(self.0.path(), None)?;
        assert_eq!((recording.format, recording.sequences.len()), ("zod", 1));
        Ok(recording.sequences.remove(0))
    }

    fn refused(&self, words: &[&str]) {
        let error = self.open().map(drop).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }

    fn file(&self, folder: &str, n: usize) -> PathBuf {
        let folder = self.0.path().join(FOLDER).join(folder);
        let mut files: Vec<PathBuf> =
            fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files.swap_remove(n)
    }
}

/// Scans that have rows: those without are not in the file.
fn counts() -> Vec<usize> {
    DETECTIONS.into_iter().filter(|count| *count > 0).collect()
}

#[test]
fn a_listed_sequence_is_read_to_the_last_field() {
    let set = DataSet::new();
    let reader = set.open().unwrap();
    let sequence = reader.sequence();
    assert_eq!((sequence.name.as_str(), reader.warnings()), ("000000", &[][..]));
    assert_eq!(sequence.times.radars, [[0, 120, 180].map(|ms| T0 + ms * 1_000_000)]);
    assert_eq!(sequence.times.lidars, [[0, 100, 200].map(|ms| T0 + ms * 1_000_000)]);
    let radar = &sequence.rig.radars[0];
    // In any order, and twice.
    for scan in [2, 0, 1, 0] {
        let read = reader.radar_scan(0, scan).unwrap();
        assert_eq!(read.len(), counts()[scan]);
        let row: Vec<f32> = read.columns.iter().map(|column| column[1]).collect();
        assert_eq!(row, [21.0, 0.1, 0.02, -18.0 * 0.1f32.cos(), 12.5, 1.0, 1.0, 2.0]);
        assert_eq!(read.columns[radar.column("validity").unwrap()][0], 0.0, "kept, whatever it says");
    }
    // The rear axle is above the road.
    assert!((radar.vehicle_from_radar.translation.z - 0.56).abs() < 1e-12);
    let camera = &sequence.rig.cameras[0];
    assert!(matches!(
        camera.intrinsics,
        Intrinsics::KannalaBrandt { distortion: [0.1, -0.02, 0.0, 0.0], .. }
    ));
    assert_eq!(reader.image(0, 1).unwrap().width, 2);
    let inputs = reader.inputs();
    assert_eq!(inputs.iter().filter(|file| file.to_string_lossy().contains("radar_front")).count(), 1);
}

#[test]
fn points_are_brought_to_the_time_of_their_scan() {
    let set = DataSet::new();
    let reader = set.open().unwrap();
    for scan in 0..3 {
        let read = reader.lidar_scan(0, scan).unwrap();
        let rolling = reader.rolling_scan(0, scan).unwrap().unwrap();
        let start_from_lidar = start_from_ego(read.t_ns) * ego_from_lidar();
        let off = |point: [f32; 3], post: [f64; 3]| {
            (start_from_lidar * Point::from(point.map(f64::from)) - Point::from(post)).norm()
        };
        for (n, post) in POSTS.into_iter().enumerate() {
            assert!(off(read.points[n], post) < 1e-3, "{}", off(read.points[n], post));
            assert!(off(rolling.points[n], post) > 0.1);
        }
        assert!(!is_return(&read.points[4]), "the own roof");
        assert_eq!((read.points.len(), read.intensity[3]), (5, 3.0));
        assert_eq!(read.times.unwrap()[0], -0.05);
    }
}

#[test]
fn compensated_points_stay_where_they_are() {
    let set = DataSet::new();
    let mark = |value: &mut Value, frames: std::ops::Range<usize>| {
        for frame in frames {
            value["train"][0]["lidar_frames"]["velodyne"][frame]["is_compensated"] = json!(true);
        }
    };
    set.edit(LIST, |list| mark(list, 0..1));
    set.refused(&[
        "sequence 000000: expected all of a sequence's LiDAR frames compensated, or none, found 1 of 3",
    ]);
    set.edit(LIST, |list| mark(list, 0..3));
    let reader = set.open().unwrap();
    assert!(reader.rolling_scan(0, 0).unwrap().is_none());
    assert!(reader.lidar_scan(0, 0).unwrap().times.is_some());
}

#[test]
fn old_downloads_are_told_what_they_lack() {
    let set = DataSet::new();
    set.edit(&format!("{FOLDER}/calibration.json"), |value| {
        value["FC"].as_object_mut().unwrap().remove("radar_extrinsics");
    });
    let reader = set.open().unwrap();
    assert!(reader.sequence().rig.radars.is_empty());
    assert!(reader.warnings()[0].contains("no `radar_extrinsics`"), "{:?}", reader.warnings());
    set.edit(LIST, |list| drop(list["train"][0].as_object_mut().unwrap().remove("radar_frames")));
    assert!(set.open().unwrap().warnings()[0].contains("no radar file is listed"));
    fs::remove_dir_all(set.0.path().join(FOLDER)).unwrap();
    set.refused(&["sequences: expected the files of at least one that is listed, found none"]);
}

#[test]
fn a_scan_of_several_times_is_told() {
    let set = DataSet::new();
    let file = set.file("radar_front", 0);
    let mut bytes = fs::read(&file).unwrap();
    // The second row of the first scan, 1 ms later.
    let rows: usize = DETECTIONS.iter().sum();
    let time = bytes.len() - (rows - 1) * 35 + 4;
    bytes[time..time + 8].copy_from_slice(&(T0 + 1_000_000).to_le_bytes());
    testing::write(&file, &bytes);
    let reader = set.open().unwrap();
    assert_eq!(
        reader.warnings(),
        ["detections of several times in 1 of the scans, which have that of their first"]
    );
    assert_eq!(reader.sequence().times.radars[0][0], T0);
}

#[test]
fn what_is_damaged_names_file_and_place() {
    let change = |name: &str, change: &dyn Fn(&mut Value), words: &[&str]| {
        let set = DataSet::new();
        set.edit(name, change);
        set.refused(words);
    };
    let [calibration, motion] = ["calibration", "ego_motion"].map(|name| format!("{FOLDER}/{name}.json"));
    change(
        LIST,
        &|v| v["train"][0]["lidar_frames"]["velodyne"][1]["time"] = json!("noon"),
        &[LIST, "`noon` as a time"],
    );
    change(
        &calibration,
        &|v| v["FC"]["lidar_extrinsics"][0][0] = json!(3.0),
        &["FC, lidar_extrinsics", "a rotation"],
    );
    change(
        &calibration,
        &|v| v["FC"]["radar_extrinsics"][1][3] = json!(1e308),
        &["calibration.json: FC, radar_extrinsics: expected at most 1000 m from the vehicle, found 1e308"],
    );
    change(&calibration, &|v| v["FC"]["image_dimensions"][0] = json!(0), &["numbers above 0"]);
    change(
        &motion,
        &|v| v["timestamps"][4] = json!(0.0),
        &["timestamps, 4: expected a time after the one before"],
    );
    change(
        &motion,
        &|v| drop(v["timestamps"].as_array_mut().unwrap().pop()),
        &["expected 80, one per pose, found 79"],
    );
    let set = DataSet::new();
    testing::write(&set.file("lidar_velodyne", 0), &npy("[('x', '<f4')]", 0, &[]));
    let error = set.open().unwrap().lidar_scan(0, 0).unwrap_err().to_string();
    assert!(error.contains("descr: expected a field `y`, found x"), "{error}");
    let radar = set.file("radar_front", 0);
    let cut = fs::read(&radar).unwrap();
    testing::write(&radar, &cut[..cut.len() - 1]);
    set.refused(&["radar_front", "data: expected 10 records of 35 bytes"]);
    let order = npy(
        "[('scan_index', '<u4'), ('timestamp', '<i8')]",
        2,
        &[[1, 0, 0, 0].as_slice(), &[9; 8], &[2, 0, 0, 0], &[1; 8]].concat(),
    );
    testing::write(&radar, &order);
    set.refused(&["record 1: expected a scan after the one before"]);
}

/// Lists the sequence once more under another number, and with another calibration.
fn twin(set: &DataSet) -> String {
    let calibration = format!("{FOLDER}/other.json");
    fs::copy(set.0.path().join(FOLDER).join("calibration.json"), set.0.path().join(&calibration)).unwrap();
    set.edit(LIST, |list| {
        let mut other = list["train"][0].clone();
        (other["id"], other["calibration_path"]) = (json!("000007"), json!(calibration));
        list["train"].as_array_mut().unwrap().push(other);
    });
    calibration
}

#[test]
fn a_damaged_sequence_costs_the_others_nothing() {
    let set = DataSet::new();
    let calibration = twin(&set);
    set.edit(&calibration, |value| value["FC"]["image_dimensions"][0] = json!(0));
    testing::check_left_out(set.0.path(), ["000000", "000007"], "other.json: ");
}

#[test]
fn a_number_that_is_listed_twice_says_the_same_or_is_refused() {
    let set = DataSet::new();
    twin(&set);
    set.edit(LIST, |list| list["val"] = list["train"].clone());
    assert_eq!(crate::read::open(set.0.path(), None).unwrap().sequences.len(), 2);
    set.edit(LIST, |list| list["val"][1]["ego_motion_path"] = json!("elsewhere.json"));
    testing::check_left_out(set.0.path(), ["000000", "000007"], "id `000007`: expected the files that ");
}
