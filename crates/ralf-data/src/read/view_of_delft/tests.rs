//! A small data set in View-of-Delft's layout, made here, and the genuine frame 00549 where it is at hand.

use super::*;
use crate::read::SequenceReader;
use crate::testing;
use ralf::sensors::Intrinsics;
use ralf::space::{Point, Vector};
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// A camera at the LiDAR, looking forward; the radar 2.5 m ahead and 1.1 m below.
const LIDAR: &str = "0 -1 0 0 0 0 -1 0 1 0 0 0";
const RADAR: &str = "0 -1 0 0 0 0 -1 1.1 1 0 0 2.5";

fn calib(velo_to_cam: &str) -> String {
    format!(
        "P0: 1\nP2: 50 0 2 0 0 50 1 0 0 0 1 0\nR0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: {velo_to_cam}\n\
         Tr_imu_to_velo:"
    )
}

/// The vehicle `x` m ahead of odom's origin, as the camera's pose.
fn pose(x: f64) -> String {
    let (x, z) = (x + 1.12, 1.49);
    let matrix = format!("[0, 0, 1, {x}, -1, 0, 0, 0, 0, -1, 0, {z}, 0, 0, 0, 1]");
    format!("{{\"mapToCamera\": [1]}}\n{{\"odomToCamera\": {matrix}}}\n{{\"UTMToCamera\": {matrix}}}")
}

fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

struct DataSet(TempDir);

impl DataSet {
    /// Frames 5, 6 and 9; the last without LiDAR, and an image of the first alone.
    fn new() -> Self {
        let set = Self(tempfile::tempdir().unwrap());
        for (stem, x) in [("00009", 3.0), ("00005", 0.0), ("00006", 1.0)] {
            set.write(
                &format!("radar/training/velodyne/{stem}.bin"),
                &floats(&[3.0, 0.0, 4.0, -20.0, -1.5, 0.5, 0.0]),
            );
            set.write(&format!("radar/training/calib/{stem}.txt"), calib(RADAR).as_bytes());
            set.write(&format!("radar/training/pose/{stem}.json"), pose(x).as_bytes());
            set.write(&format!("lidar/training/calib/{stem}.txt"), calib(LIDAR).as_bytes());
        }
        for stem in ["00005", "00006"] {
            set.write(
                &format!("lidar/training/velodyne/{stem}.bin"),
                &floats(&[1.0, 2.0, 3.0, 0.5, 4.0, 5.0, 6.0, 0.25]),
            );
        }
        set.write("radar/training/velodyne/notes.txt", b"not a frame");
        set.write("radar/training/velodyne/._00005.bin", b"what macOS leaves beside a file");
        let images = set.path("radar/training/image_2");
        fs::create_dir_all(&images).unwrap();
        image::RgbImage::new(8, 4).save(images.join("00005.jpg")).unwrap();
        set
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        testing::write(&self.path(name), bytes);
    }

    fn open(&self) -> Result<Box<dyn SequenceReader>, DataError> {
        Ok(open(self.0.path(), &[])?.sequences.remove(0))
    }

    /// The error of opening, which must hold all of the words.
    fn refused(&self, words: &[&str]) {
        let error = self.open().map(drop).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
}

#[test]
fn frames_become_a_sequence() {
    let set = DataSet::new();
    assert!(recognises(set.0.path()));
    let training = set.open().unwrap();
    let sequence = training.sequence();
    assert_eq!(sequence.name, "training");
    let at = |frame: i64| frame * 100_000_000;
    assert_eq!(sequence.times.radars, [[at(5), at(6), at(9)]]);
    assert_eq!((&sequence.times.lidars[0], &sequence.times.cameras[0]), (&vec![at(5), at(6)], &vec![at(5)]));
    assert_eq!(
        training.warnings(),
        [
            "1 of 3 files of lidar are not there and were left out",
            "2 of 3 files of camera are not there and were left out"
        ]
    );
    let radar = &sequence.rig.radars[0];
    assert!((radar.vehicle_from_radar.translation.vector - Vector::new(3.62, 0.0, 0.39)).norm() < 1e-9);
    assert!(radar.vehicle_from_radar.rotation.angle() < 1e-9);
    let camera = &sequence.rig.cameras[0];
    let ahead = camera.vehicle_from_camera * Point::new(0.0, 0.0, 10.0);
    assert!((ahead - Point::new(11.12, 0.0, 1.49)).norm() < 1e-9);
    assert_eq!((camera.width, camera.height), (8, 4));
    let moved = sequence.motion.between(at(5), at(9));
    assert!(
        (moved.translation.vector - Vector::new(3.0, 0.0, 0.0)).norm() < 1e-9
            && moved.rotation.angle() < 1e-9
    );
}

#[test]
fn measurements_are_read_to_the_last_column() {
    let set = DataSet::new();
    let training = set.open().unwrap();
    let scan = training.radar_scan(0, 2).unwrap();
    let fields = &training.sequence().rig.radars[0].fields;
    let row: Vec<_> =
        fields.iter().zip(&scan.columns).map(|(name, column)| (name.as_str(), column[0])).collect();
    let expected = [
        ("x", 3.0),
        ("y", 0.0),
        ("z", 4.0),
        ("rcs", -20.0),
        ("doppler", -1.5),
        ("doppler_compensated", 0.5),
        ("time", 0.0),
    ];
    assert_eq!(row, expected);
    assert!((scan.spherical[0].range - 5.0).abs() < 1e-12, "elevation is measured");
    let cloud = training.lidar_scan(0, 1).unwrap();
    assert_eq!((cloud.points, cloud.intensity), (vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]], vec![0.5, 0.25]));
    assert_eq!(training.image(0, 0).unwrap().rgb.len(), 32);
    assert!(training.depth(0, 0).unwrap().is_none());
    let inputs = training.inputs();
    assert_eq!(inputs.len(), 3 * 3 + 3 + 2 + 1);
    assert!(inputs.iter().all(|file| file.is_file()));
    assert!(training.image_file(0, 0).is_some() && training.image_file(0, 1).is_none());
}

#[test]
fn a_scan_without_detections_is_empty() {
    let set = DataSet::new();
    set.write("radar/training/velodyne/00006.bin", b"");
    assert!(set.open().unwrap().radar_scan(0, 1).unwrap().is_empty());
}

#[test]
fn frames_that_disagree_are_warned_of() {
    let set = DataSet::new();
    set.write("radar/training/calib/00006.txt", calib(&RADAR.replace("2.5", "2.502")).as_bytes());
    set.write("radar/training/calib/00009.txt", calib(&RADAR.replace("2.5", "2.5005")).as_bytes());
    set.write("radar/training/pose/00006.json", pose(40.0).as_bytes());
    let turned = pose(3.0).replace("0, 0, 1, 4.12, -1, 0, 0, 0,", "1, 0, 0, 4.12, 0, 0, 1, 0,");
    assert_ne!(turned, pose(3.0));
    set.write("radar/training/pose/00009.json", turned.as_bytes());
    let warnings = set.open().unwrap().warnings().join("\n");
    assert!(
        warnings.contains("calibration of 1 frames (00006 first) is not that of frame 00005"),
        "{warnings}"
    );
    assert!(warnings.contains("jumps by 40.0 m and 0 degrees between the frames 5 and 6"), "{warnings}");
    assert!(warnings.contains("and 90 degrees between the frames 6 and 9"), "{warnings}");
}

#[test]
fn damaged_calibrations_name_the_place() {
    let cases = [
        (calib("0 -1 0 0 0 0 -1 0 1 0 0"), "00005.txt: line 4: expected `Tr_velo_to_cam:` and 12 numbers"),
        (calib("0 -1 0 0 0 0 -1 0 1 0 0 x"), "line 4"),
        (calib("0 -1 0 0 0 0 -1 0 1 0 0 NaN"), "line 4"),
        (
            calib("0 -1 0 1e308 0 0 -1 0 1 0 0 0"),
            "Tr_velo_to_cam: expected at most 1000 m from the vehicle, found 1e308",
        ),
        (calib("0 -1.01 0 0 0 0 -1 0 1 0 0 0"), "Tr_velo_to_cam: expected a rotation, orthonormal within"),
        (calib("0 1 0 0 0 0 -1 0 1 0 0 0"), "determinant -1"),
        ("P2: 1\n".to_owned(), "line 1: expected `P2:` and 12 numbers, found 1"),
        (calib(LIDAR).replace("R0_rect", "R1_rect"), "`R0_rect:` and 9 numbers, found no such line"),
    ];
    for (text, words) in cases {
        let set = DataSet::new();
        set.write("lidar/training/calib/00005.txt", text.as_bytes());
        set.refused(&[words, "lidar/training/calib/00005.txt"]);
    }
    let set = DataSet::new();
    set.write("radar/training/calib/00005.txt", calib(RADAR).replace("P2: 50 0", "P2: 50 1").as_bytes());
    set.refused(&["00005.txt: P2: expected fx 0 cx 0"]);
    fs::remove_file(set.path("radar/training/calib/00006.txt")).unwrap();
    set.refused(&["calib/00006.txt"]);
}

#[test]
fn damaged_poses_name_the_place() {
    let cases = [
        (pose(0.0).replace("UTM", "\"").replace("1.49", ""), "line 2"),
        (pose(0.0).replace("0, 0, 0, 1]", "0, 0, 1, 1]"), "a last row of 0 0 0 1"),
        (pose(0.0).replace("[0, 0, 1,", "[0, 0, 2,"), "odomToCamera: expected a rotation"),
        (pose(0.0).replace("0, 0, 0, 1]", "0, 0, 0]"), "line 2"),
    ];
    for (text, words) in cases {
        let set = DataSet::new();
        set.write("radar/training/pose/00006.json", text.as_bytes());
        set.refused(&["pose/00006.json", words]);
    }
    let set = DataSet::new();
    for stem in ["00005", "00006", "00009"] {
        set.write(&format!("radar/training/pose/{stem}.json"), b"{}");
    }
    set.refused(&["training/pose: poses: expected one per frame, found none"]);
    fs::remove_dir_all(set.path("radar/training/pose")).unwrap();
    set.refused(&["training/pose", "motion is unknown"]);
}

/// As the published data set has them: the first frames of two drives.
#[test]
fn frames_without_a_pose_lie_between_the_others() {
    let at = |frame: i64| frame * 100_000_000;
    let cut = pose(1.0);
    let without = ["", "{\"mapToCamera\": [1]}", &cut[..60]];
    for (stem, text) in
        ["00005", "00006", "00009"].into_iter().flat_map(|stem| without.map(|text| (stem, text)))
    {
        let set = DataSet::new();
        set.write(&format!("radar/training/pose/{stem}.json"), text.as_bytes());
        let training = set.open().unwrap();
        let told = format!("1 of 3 frames have no pose ({stem} first)");
        assert!(training.warnings()[0].starts_with(&told), "{:?}", training.warnings());
        // The vehicle drives on as it does between the others: 1 m a frame, or .75 or .5 m.
        let driven = training.sequence().motion.between(at(5), at(9)).translation.x;
        let expected = match stem {
            "00005" => 4.0 * 2.0 / 3.0,
            "00006" => 3.0,
            _ => 4.0,
        };
        assert!((driven - expected).abs() < 1e-9, "{stem}: {driven}");
        assert!(training.inputs().iter().all(|file| file.is_file()));
    }
    let set = DataSet::new();
    fs::remove_file(set.path("radar/training/pose/00006.json")).unwrap();
    assert!(set.open().unwrap().inputs().iter().all(|file| file.is_file()));
}

#[test]
fn every_drive_is_a_sequence() {
    let set = DataSet::new();
    for (from, stem) in [("00005", "00543"), ("00006", "00544"), ("00009", "04048")] {
        for folder in
            ["radar/training/velodyne", "radar/training/calib", "lidar/training/calib", "radar/training/pose"]
        {
            let extension = if folder.ends_with("calib") {
                "txt"
            } else if folder.ends_with("pose") {
                "json"
            } else {
                "bin"
            };
            let [from, to] = [from, stem].map(|stem| set.path(&format!("{folder}/{stem}.{extension}")));
            fs::copy(from, to).unwrap();
        }
    }
    let names = |wanted: &[&str]| {
        let wanted: Vec<String> = wanted.iter().map(|name| (*name).to_owned()).collect();
        let recording = open(set.0.path(), &wanted).unwrap();
        let lost: Vec<String> = recording.incomplete.iter().map(|lost| lost.name.clone()).collect();
        let read = |reader: &dyn SequenceReader| {
            (reader.sequence().name.clone(), reader.sequence().times.radars[0].len())
        };
        (recording.sequences.iter().map(|reader| read(reader.as_ref())).collect::<Vec<_>>(), lost)
    };
    let [first, second, other] =
        [("delft_1", 4), ("delft_2", 1), ("training", 1)].map(|(name, n)| (name.to_owned(), n));
    assert_eq!(names(&[]).0, [first.clone(), second, other.clone()]);
    // What is wrong with one drive costs the others nothing.
    fs::remove_file(set.path("radar/training/calib/00544.txt")).unwrap();
    assert_eq!(names(&[]), (vec![first.clone(), other], vec!["delft_2".to_owned()]));
    assert_eq!(names(&["delft_1"]), (vec![first], vec![]));
    assert!(open(set.0.path(), &["delft_2".to_owned()]).is_err());
}

/// The radar's folders of images and poses are links, which not every system copies.
#[test]
fn images_and_poses_are_found_beside_the_lidar() {
    let set = DataSet::new();
    for folder in ["image_2", "pose"] {
        fs::rename(
            set.path(&format!("radar/training/{folder}")),
            set.path(&format!("lidar/training/{folder}")),
        )
        .unwrap();
    }
    set.write("radar/training/pose", b"../../lidar/training/pose");
    let training = set.open().unwrap();
    assert_eq!(
        (training.sequence().motion.poses().len(), training.sequence().times.cameras[0].len()),
        (3, 1)
    );
}

#[test]
fn damaged_measurements_and_names_are_refused() {
    let set = DataSet::new();
    set.write("radar/training/velodyne/00005.bin", &[0; 30]);
    let error = set.open().unwrap().radar_scan(0, 0).unwrap_err().to_string();
    assert!(error.contains("00005.bin: byte 28: expected rows of 7 float32"), "{error}");
    set.write("radar/training/velodyne/5.bin", b"");
    set.refused(&["one file per frame, found 00005 and 5"]);
    set.write("radar/training/velodyne/first.bin", b"");
    set.refused(&["first.bin: file name: expected a frame's number"]);
    let empty = tempfile::tempdir().unwrap();
    assert!(open(empty.path(), &[]).is_err() && !recognises(empty.path()));
    fs::create_dir_all(empty.path().join("radar/training/velodyne")).unwrap();
    assert!(
        open(empty.path(), &[])
            .map(drop)
            .unwrap_err()
            .to_string()
            .contains("expected frames, NNNNN.bin, found none")
    );
}

#[test]
fn the_genuine_frame() {
    let Some(folder) = testing::data("view-of-delft") else { return };
    let recording = crate::read::open(&folder, None).unwrap();
    assert_eq!(recording.format, "view-of-delft");
    let training = &recording.sequences[0];
    assert!(training.warnings().is_empty(), "{:?}", training.warnings());
    let sequence = training.sequence();
    assert_eq!(sequence.times.radars, [[54_900_000_000]]);
    let [radar, lidar] =
        [&sequence.rig.radars[0].vehicle_from_radar, &sequence.rig.lidars[0].vehicle_from_lidar];
    let lidar_from_radar = lidar.inv_mul(radar);
    let expected = Vector::new(2.5144, 0.0607, -1.1533);
    assert!((lidar_from_radar.translation.vector - expected).norm() < 2e-4, "{lidar_from_radar}");
    let (roll, pitch, yaw) = lidar_from_radar.rotation.euler_angles();
    for (found, expected) in [(roll, 0.14), (pitch, -0.52), (yaw, 0.35)] {
        assert!((found.to_degrees() - expected).abs() < 0.01, "{found}");
    }
    let camera = &sequence.rig.cameras[0];
    let Intrinsics::Pinhole { focal, center, .. } = camera.intrinsics else {
        panic!("{:?}", camera.intrinsics)
    };
    assert_eq!((focal, center), ([1495.468642; 2], [961.272442, 624.89592]));
    assert_eq!((camera.width, camera.height), (1936, 1216));
    // As the pose says, the camera is 1.30 m above odom's origin and the car is on its wheels.
    let odom_from_vehicle = sequence.motion.poses()[0].odom_from_vehicle;
    assert!(((odom_from_vehicle * camera.vehicle_from_camera).translation.z - 1.2994).abs() < 1e-3);
    assert!((odom_from_vehicle * Vector::z()).z > 0.99);
    assert_eq!(training.image(0, 0).unwrap().rgb.len(), 1936 * 1216);

    let scan = training.radar_scan(0, 0).unwrap();
    let cloud = training.lidar_scan(0, 0).unwrap();
    assert_eq!((scan.len(), cloud.points.len()), (322, 167_772));
    assert!(scan.positions.iter().all(|p| p.coords.norm() < 100.0));
}
