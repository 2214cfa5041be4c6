//! A small data set in nuScenes' layout, made here, and the genuine scene-0061 where it is at hand.

use super::*;
use crate::testing;
use ralf::sensors::Intrinsics;
use ralf::space::Point;
use serde_json::{Value, json};
use tempfile::TempDir;

/// Microseconds of the first measurement.
const T0: i64 = 1_532_402_927_600_000;
const MS: i64 = 1000;
const VERSION: &str = "v1.0-test";

const HEADER: &str = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n\
    FIELDS x y z dyn_prop id rcs vx vy vx_comp vy_comp is_quality_valid ambig_state x_rms y_rms invalid_state pdh0 vx_rms vy_rms\n\
    SIZE 4 4 4 1 2 4 4 4 4 4 1 1 1 1 1 1 1 1\nTYPE F F F I I F F F F F I I I I I I I I\n\
    COUNT 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\nWIDTH {n}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {n}\nDATA binary\n";

fn detection(x: f32, y: f32, id: i16, velocities: [f32; 4]) -> Vec<u8> {
    let mut bytes: Vec<u8> = [x, y, 0.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    bytes.push(3);
    bytes.extend(id.to_le_bytes());
    bytes.extend([7.5].iter().chain(&velocities).flat_map(|v: &f32| v.to_le_bytes()));
    bytes.extend([1, 3, 20, 21, 17, 2, (-4_i8).cast_unsigned(), 5]);
    assert_eq!(bytes.len(), 43);
    bytes
}

/// As nuScenes writes it: 4096 bytes more than the records take.
fn pcd(records: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = HEADER.replace("{n}", &records.len().to_string()).into_bytes();
    bytes.extend(records.concat());
    bytes.resize(4096 + 43 * records.len(), 0);
    bytes
}

struct DataSet(TempDir);

impl DataSet {
    /// Two radars, a LiDAR, a camera, the CAN bus; rows and keys in no particular order.
    fn new() -> Self {
        let set = Self(tempfile::tempdir().unwrap());
        set.write_tables();
        let one = pcd(&[
            detection(3.0, 4.0, 300, [1.0, 2.0, -5.0, 0.0]),
            detection(0.0, -2.0, 1, [9.0, 1.0, 0.0, 0.0]),
        ]);
        set.write("samples/RADAR_FRONT/a.pcd", &one);
        set.write("sweeps/RADAR_FRONT/b.pcd", &pcd(&[detection(1.0, 0.0, 0, [0.5, 0.0, 0.0, 0.0])]));
        set.write("sweeps/RADAR_FRONT/c.pcd", &pcd(&[detection(f32::NAN, f32::NAN, -1, [0.0; 4])]));
        set.write("samples/RADAR_BACK_LEFT/a.pcd", &one);
        let lidar: Vec<u8> = [1.0_f32, 2.0, 3.0, 200.0, 31.0].iter().flat_map(|v| v.to_le_bytes()).collect();
        set.write("samples/LIDAR_TOP/a.pcd.bin", &lidar);
        image::RgbImage::from_fn(4, 2, |x, y| image::Rgb([x as u8, y as u8, 9]))
            .save(set.folder("samples/CAM_FRONT").join("a.png"))
            .unwrap();
        set
    }

    fn write_tables(&self) {
        let turn = [1.0, 0.0, 0.0, 0.0];
        let sensor = |channel: &str, modality: &str| json!({"modality": modality, "token": channel, "channel": channel});
        self.table(
            "sensor",
            json!([
                sensor("CAM_FRONT", "camera"),
                sensor("RADAR_BACK_LEFT", "radar"),
                sensor("LIDAR_TOP", "lidar"),
                sensor("RADAR_FRONT", "radar")
            ]),
        );
        let mounted = |name: &str, rotation: [f64; 4], k: Value| {
            json!({"token": format!("cs-{name}"), "sensor_token": name, "translation": [3.0, 1.0, 0.5],
                   "rotation": rotation, "camera_intrinsic": k})
        };
        let half = std::f64::consts::FRAC_1_SQRT_2;
        self.table(
            "calibrated_sensor",
            json!([
                mounted("RADAR_FRONT", turn, json!([])),
                mounted("RADAR_BACK_LEFT", [half, 0.0, 0.0, half], json!([])),
                mounted("LIDAR_TOP", turn, json!([])),
                mounted("CAM_FRONT", turn, json!([[10.0, 0.0, 1.5], [0.0, 11.0, 0.5], [0.0, 0.0, 1.0]]))
            ]),
        );
        self.table(
            "log",
            json!([{"token": "l", "location": "boston", "date_captured": "2018-07-24", "vehicle": "n"}]),
        );
        self.table(
            "scene",
            json!([{"token": "s", "log_token": "l", "name": "scene-0001", "description": "Turn", "nbr_samples": 1}]),
        );
        self.table("sample", json!([{"token": "x", "scene_token": "s", "timestamp": T0}]));
        let data = [
            ("RADAR_FRONT", "sweeps/RADAR_FRONT/c.pcd", 150, [0, 0]),
            ("CAM_FRONT", "samples/CAM_FRONT/a.png", 30, [4, 2]),
            ("RADAR_BACK_LEFT", "sweeps/RADAR_BACK_LEFT/b.pcd", 95, [0, 0]),
            ("RADAR_FRONT", "samples/RADAR_FRONT/a.pcd", 0, [0, 0]),
            ("LIDAR_TOP", "samples/LIDAR_TOP/a.pcd.bin", 50, [0, 0]),
            ("RADAR_BACK_LEFT", "samples/RADAR_BACK_LEFT/a.pcd", 20, [0, 0]),
            ("RADAR_FRONT", "sweeps/RADAR_FRONT/b.pcd", 75, [0, 0]),
        ];
        let rows = data.iter().map(|(sensor, file, ms, [width, height])| {
            json!({"token": file, "sample_token": "x", "ego_pose_token": format!("{ms}"), "is_key_frame": true,
                   "calibrated_sensor_token": format!("cs-{sensor}"), "timestamp": T0 + ms * MS, "filename": file,
                   "width": width, "height": height, "fileformat": "", "prev": "", "next": ""})
        });
        self.table("sample_data", rows.collect());
        let poses = data.iter().map(|(_, _, ms, _)| {
            json!({"token": format!("{ms}"), "timestamp": T0 + ms * MS, "rotation": turn,
                   "translation": [0.01 * *ms as f64, 7.0, 0.0]})
        });
        self.table("ego_pose", poses.collect());
        let can = |ms: i64, v: f64| json!({"utime": T0 + ms * MS, "vel": [v, 0.0, 0.0], "rotation_rate": [9.0, 9.0, 0.25], "pos": [0, 0, 0]});
        self.write(
            "can_bus/scene-0001_pose.json",
            json!([can(20, 10.0), can(0, 9.0)]).to_string().as_bytes(),
        );
    }

    fn folder(&self, name: &str) -> PathBuf {
        let folder = self.0.path().join(name);
        fs::create_dir_all(&folder).unwrap();
        folder
    }

    fn write(&self, name: &str, bytes: &[u8]) {
        testing::write(&self.0.path().join(name), bytes);
    }

    fn table(&self, name: &str, rows: Value) {
        self.write(
            &format!("{VERSION}/{name}.json"),
            serde_json::to_string_pretty(&rows).unwrap().as_bytes(),
        );
    }

    fn edit(&self, table: &str, change: impl FnOnce(&mut Vec<Value>)) {
        let text =
            fs::read_to_string(self.0.path().join(VERSION).join(table).with_extension("json")).unwrap();
        let mut rows: Vec<Value> = serde_json::from_str(&text).unwrap();
        change(&mut rows);
        self.table(table, Value::Array(rows));
    }

    fn open(&self) -> Result<Box<dyn SequenceReader>, DataError> {
        let mut recording = open(self.0.path())?;
        assert_eq!(recording.format, "nuscenes");
        Ok(recording.sequences.remove(0))
    }

    /// The error of opening, which must hold all of the words.
    fn refused(&self, words: &[&str]) {
        let error = self.open().map(drop).unwrap_err().to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    }
}

#[test]
fn tables_in_any_order_become_a_scene() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    let sequence = scene.sequence();
    assert_eq!(
        (sequence.name.as_str(), sequence.title.as_str()),
        ("scene-0001", "Turn (boston, 2018-07-24)")
    );
    let names: Vec<_> = sequence.rig.radars.iter().map(|radar| radar.name.as_str()).collect();
    assert_eq!(names, ["RADAR_FRONT", "RADAR_BACK_LEFT"]);
    let at = |ms: i64| (T0 + ms * MS) * 1000;
    assert_eq!(sequence.times.radars, [vec![at(0), at(75), at(150)], vec![at(20)]]);
    assert_eq!((&sequence.times.lidars, &sequence.times.cameras), (&vec![vec![at(50)]], &vec![vec![at(30)]]));
    assert_eq!(scene.warnings(), ["1 of 2 files of RADAR_BACK_LEFT are not there and were left out"]);

    // A quarter turn to the left, in w x y z.
    let ahead = sequence.rig.radars[1].vehicle_from_radar * Point::new(1.0, 0.0, 0.0);
    assert!((ahead - Point::new(3.0, 2.0, 0.5)).norm() < 1e-9);
    let camera = &sequence.rig.cameras[0];
    let Intrinsics::Pinhole { focal, center, .. } = camera.intrinsics else {
        panic!("{:?}", camera.intrinsics)
    };
    assert_eq!((focal, center, camera.width, camera.height), ([10.0, 11.0], [1.5, 0.5], 4, 2));

    let poses = sequence.motion.poses();
    assert_eq!(poses.len(), 7);
    assert!(poses.is_sorted_by(|a, b| a.t_ns < b.t_ns));
    assert!((sequence.motion.odom_from_vehicle(at(85)).translation.x - 0.85).abs() < 1e-9);
    let odometry: Vec<_> =
        sequence.motion.odometry().iter().map(|s| (s.t_ns, s.velocity, s.yaw_rate)).collect();
    assert_eq!(odometry, [(at(0), 9.0, 0.25), (at(20), 10.0, 0.25)]);
}

#[test]
fn measurements_are_read_to_the_last_field() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    let radar = &scene.sequence().rig.radars[0];
    let scan = scene.radar_scan(0, 0).unwrap();
    assert_eq!(scan.len(), 2);
    let first: Vec<_> =
        radar.fields.iter().zip(&scan.columns).map(|(name, column)| (name.as_str(), column[0])).collect();
    let expected = [
        ("x", 3.0),
        ("y", 4.0),
        ("z", 0.0),
        ("dyn_prop", 3.0),
        ("id", 300.0),
        ("rcs", 7.5),
        ("vx", 1.0),
        ("vy", 2.0),
        ("vx_comp", -5.0),
        ("vy_comp", 0.0),
        ("is_quality_valid", 1.0),
        ("ambig_state", 3.0),
        ("x_rms", 20.0),
        ("y_rms", 21.0),
        ("invalid_state", 17.0),
        ("pdh0", 2.0),
        ("vx_rms", -4.0),
        ("vy_rms", 5.0),
        ("doppler", 2.2),
        ("doppler_compensated", -3.0),
    ];
    assert_eq!(first, expected);
    assert_eq!(scan.columns[18][1], -1.0);
    assert!(scene.radar_scan(0, 2).unwrap().is_empty(), "NaN with id -1 is an empty scan");
    let cloud = scene.lidar_scan(0, 0).unwrap();
    assert_eq!((cloud.points, cloud.intensity), (vec![[1.0, 2.0, 3.0]], vec![200.0]));
    assert_eq!(scene.image(0, 0).unwrap().rgb[6], [2, 1, 9]);
    assert!(scene.depth(0, 0).unwrap().is_none());
    let inputs = scene.inputs();
    assert_eq!(inputs.len(), 7 + 1 + 4 + 1 + 1);
    assert!(inputs.iter().all(|file| file.is_file()));
    assert_eq!(scene.image_file(0, 0).unwrap(), set.0.path().join("samples/CAM_FRONT/a.png"));
    assert!(scene.image_file(0, 1).is_none() && scene.image_file(1, 0).is_none());
}

#[test]
fn scans_keep_their_names_in_the_tables() {
    let set = DataSet::new();
    let scene = set.open().unwrap();
    let origin = scene.origin().and_then(|origin| origin.downcast_ref::<super::NuScenesOrigin>()).unwrap();
    let token = |scan| origin.sample_data_token(0, scan).map(|token| (origin.version.clone(), token));
    // Of the fixture's tables: a token is the file's name.
    for (scan, file) in [(0, "samples/RADAR_FRONT/a.pcd"), (2, "sweeps/RADAR_FRONT/c.pcd")] {
        assert_eq!(token(scan), Some((VERSION.to_owned(), file.to_owned())));
    }
    assert_eq!((token(3), origin.sample_data_token(9, 0)), (None, None));
}

#[test]
fn a_nan_that_is_not_the_mark_of_an_empty_scan_stays() {
    let set = DataSet::new();
    set.write("sweeps/RADAR_FRONT/b.pcd", &pcd(&[detection(f32::NAN, f32::NAN, 4, [0.0; 4])]));
    assert_eq!(set.open().unwrap().radar_scan(0, 1).unwrap().len(), 1);
}

#[test]
fn folders_that_are_missing_leave_timelines_empty() {
    let set = DataSet::new();
    for folder in ["samples/LIDAR_TOP", "samples/RADAR_BACK_LEFT", "can_bus"] {
        fs::remove_dir_all(set.0.path().join(folder)).unwrap();
    }
    let scene = set.open().unwrap();
    let times = &scene.sequence().times;
    assert_eq!((times.lidars[0].len(), times.radars[1].len(), scene.warnings().len()), (0, 0, 2));
    assert!(scene.sequence().motion.odometry().is_empty());
}

#[test]
fn scans_that_are_damaged_name_the_place() {
    let whole = pcd(&[detection(1.0, 0.0, 0, [0.0; 4])]);
    let text = |from: &str, to: &str| {
        let mut bytes = HEADER.replace("{n}", "1").replace(from, to).into_bytes();
        bytes.extend(detection(1.0, 0.0, 0, [0.0; 4]));
        bytes
    };
    let data = HEADER.replace("{n}", "1").len();
    let cases: Vec<(Vec<u8>, String)> = vec![
        (
            whole[..data + 42].to_vec(),
            format!("byte {}: expected 1 records of 43 bytes from byte {data}", data + 42),
        ),
        (whole[..data - 15].to_vec(), "expected a PCD header up to `DATA binary`".into()),
        (vec![0xff; 40], "byte 0".into()),
        (vec![], "byte 0: expected a PCD header".into()),
        (text("DATA binary", "DATA ascii"), "DATA: expected binary, found ascii".into()),
        (text(" vy_rms", ""), "SIZE: expected 17 entries, one per field, found 18".into()),
        (text("invalid_state", "state"), "a field `invalid_state`".into()),
        (text("COUNT 1 1 1 1 1", "COUNT 1 1 1 1 2"), "field `id`".into()),
        (text("SIZE 4", "SIZE 8"), "field `x`: expected one value of type F 4".into()),
        (text("WIDTH 1", "WIDTH -1"), "WIDTH: expected a whole number, found -1".into()),
        (text("WIDTH 1", "WIDTH 2"), "POINTS: expected WIDTH x HEIGHT = 2 x 1, found 1".into()),
        (text("POINTS 1\n", ""), "header: expected a line `POINTS`".into()),
        (text("WIDTH 1", "WIDTH 18446744073709551615"), "POINTS: expected".into()),
    ];
    for (bytes, words) in cases {
        let set = DataSet::new();
        set.write("samples/RADAR_FRONT/a.pcd", &bytes);
        let error = set.open().unwrap().radar_scan(0, 0).unwrap_err().to_string();
        assert!(error.contains(&words) && error.contains("a.pcd"), "{error} lacks {words}");
    }
}

#[test]
fn clouds_and_images_that_are_damaged_name_the_file() {
    let set = DataSet::new();
    set.write("samples/LIDAR_TOP/a.pcd.bin", &[0; 21]);
    let error = set.open().unwrap().lidar_scan(0, 0).unwrap_err().to_string();
    assert!(error.contains("a.pcd.bin: byte 20"), "{error}");
    image::RgbImage::new(5, 2).save(set.folder("samples/CAM_FRONT").join("a.png")).unwrap();
    let error = set.open().unwrap().image(0, 0).unwrap_err().to_string();
    assert!(
        error.contains("a.png: image size: expected 4 x 2 px, as the camera has, found 5 x 2 px"),
        "{error}"
    );
    set.write("samples/CAM_FRONT/a.png", b"no image");
    let error = set.open().unwrap().image(0, 0).unwrap_err().to_string();
    assert!(error.contains("a.png: content"), "{error}");
}

#[test]
fn tables_that_contradict_each_other_are_refused() {
    let change = |table: &str, key: &str, value: Value, words: &[&str]| {
        let set = DataSet::new();
        set.edit(table, |rows| rows[0][key] = value);
        set.refused(words);
    };
    change(
        "sample_data",
        "sample_token",
        json!("?"),
        &["sample_data.json: line 1", "`?`, which sample.json lacks"],
    );
    change("sample_data", "calibrated_sensor_token", json!("?"), &["which calibrated_sensor.json lacks"]);
    change("sample_data", "ego_pose_token", json!("?"), &["ego_pose.json: tokens", "no `?`"]);
    change("sample_data", "timestamp", json!("soon"), &["sample_data.json: line", "invalid type: string"]);
    change("sample_data", "timestamp", json!(i64::MAX), &["sample_data.json: line", "out of range"]);
    change("calibrated_sensor", "sensor_token", json!("?"), &["calibrated_sensor.json", "sensor.json lacks"]);
    change("calibrated_sensor", "rotation", json!([0, 0, 0, 0]), &["no unit quaternion w x y z"]);
    change("ego_pose", "rotation", json!([1, 0, 0]), &["ego_pose.json", "invalid length 3"]);
    change("sensor", "modality", json!("sonar"), &["sensor.json", "unknown variant `sonar`"]);
    change("sensor", "token", json!("x".repeat(33)), &["sensor.json", "at most 32 characters"]);
    change("sample", "scene_token", json!("?"), &["sample.json", "scene.json lacks"]);
    change("scene", "log_token", json!("?"), &["scene.json", "log.json lacks"]);
    let set = DataSet::new();
    set.edit("calibrated_sensor", |rows| rows[3]["camera_intrinsic"][0][1] = json!(0.5));
    set.refused(&["calibrated_sensor.json: camera_intrinsic of CAM_FRONT"]);
}

#[test]
fn a_calibration_that_changes_inside_a_scene_is_refused() {
    let set = DataSet::new();
    set.edit("calibrated_sensor", |rows| {
        let mut other = rows[0].clone();
        (other["token"], other["translation"]) = (json!("other"), json!([3.0, 1.0, 0.6]));
        rows.push(other);
    });
    set.edit("sample_data", |rows| rows[0]["calibrated_sensor_token"] = json!("other"));
    set.refused(&[
        "sample_data.json: line",
        "calibrated_sensor of RADAR_FRONT that changes inside scene-0001",
    ]);
}

#[test]
fn a_scene_without_poses_is_refused() {
    let set = DataSet::new();
    set.edit("scene", |rows| {
        let mut other = rows[0].clone();
        (other["token"], other["name"]) = (json!("t"), json!("scene-0000"));
        rows.push(other);
    });
    set.refused(&["scene `scene-0000`", "at least one measurement with its ego pose"]);
}

#[test]
fn cut_and_missing_tables_are_named() {
    let set = DataSet::new();
    set.write(&format!("{VERSION}/ego_pose.json"), b"[{\"token\": \"a\", ");
    set.refused(&["ego_pose.json: line 1", "EOF"]);
    fs::remove_file(set.0.path().join(VERSION).join("log.json")).unwrap();
    set.refused(&["log.json"]);
}

#[test]
fn exactly_one_version_folder() {
    let set = DataSet::new();
    assert!(recognises(set.0.path()));
    set.folder("v1.0-mini");
    set.refused(&["exactly one version folder", "found v1.0-mini, v1.0-test"]);
    let empty = tempfile::tempdir().unwrap();
    assert!(open(empty.path()).map(drop).unwrap_err().to_string().contains("found none"));
    assert!(!recognises(empty.path()));
}

#[test]
fn the_genuine_scene() {
    let Some(folder) = testing::data("nuscenes") else { return };
    let recording = crate::read::open(&folder, None).unwrap();
    assert_eq!(recording.format, "nuscenes");
    assert_eq!(recording.sequences.len(), 1);
    let scene = &recording.sequences[0];
    let sequence = scene.sequence();
    let names =
        |radars: &[ralf::sensors::Radar]| radars.iter().map(|radar| radar.name.clone()).collect::<Vec<_>>();
    let expected =
        ["RADAR_FRONT", "RADAR_FRONT_LEFT", "RADAR_FRONT_RIGHT", "RADAR_BACK_LEFT", "RADAR_BACK_RIGHT"];
    assert_eq!(names(&sequence.rig.radars), expected);
    let cameras: Vec<_> = sequence.rig.cameras.iter().map(|camera| camera.name.as_str()).collect();
    let expected =
        ["CAM_FRONT", "CAM_FRONT_LEFT", "CAM_FRONT_RIGHT", "CAM_BACK", "CAM_BACK_LEFT", "CAM_BACK_RIGHT"];
    assert_eq!((sequence.name.as_str(), cameras.as_slice()), ("scene-0061", &expected[..]));
    assert!(scene.warnings().is_empty(), "{:?}", scene.warnings());

    let mut sizes = Vec::new();
    for (radar, times) in sequence.times.radars.iter().enumerate() {
        assert!(times.is_sorted_by(|a, b| a < b));
        sizes.extend((0..times.len()).map(|scan| scene.radar_scan(radar, scan).unwrap().len()));
    }
    assert_eq!((sizes.len(), sizes.iter().sum::<usize>()), (1263, 126_749));
    assert_eq!((sizes.iter().min(), sizes.iter().max()), (Some(&2), Some(&125)));
    assert_eq!(scene.lidar_scan(0, 0).unwrap().points.len(), 34_688);
    let image = scene.image(0, 0).unwrap();
    assert_eq!((image.width, image.height), (1600, 900));

    // 91 m of road, turning by 98 deg.
    let motion = &sequence.motion;
    let poses = motion.poses();
    let turn =
        motion.between(poses[0].t_ns, poses[poses.len() - 1].t_ns).rotation.euler_angles().2.to_degrees();
    assert!((turn.abs() - 98.0).abs() < 1.0, "{turn}");
    assert!(motion.odometry().len() > 900 && (motion.odometry()[0].velocity - 8.99).abs() < 0.01);
}

/// What stands still has no Doppler velocity of its own: `doppler_compensated` is `doppler` plus the vehicle's motion.
#[test]
fn the_genuine_velocities_agree_with_the_motion() {
    let Some(folder) = testing::data("nuscenes") else { return };
    let recording = crate::read::open(&folder, None).unwrap();
    assert_eq!(recording.format, "nuscenes");
    let scene = &recording.sequences[0];
    let radar = &scene.sequence().rig.radars[0];
    let scan = scene.radar_scan(0, 20).unwrap();
    let (linear, angular) = scene.sequence().motion.twist(scan.t_ns);
    let mounting = radar.vehicle_from_radar;
    let velocity = mounting.rotation.inverse() * (linear + angular.cross(&mounting.translation.vector));
    let [raw, compensated] =
        ["doppler", "doppler_compensated"].map(|name| &scan.columns[radar.column(name).unwrap()]);
    let mut differences: Vec<f64> = (0..scan.len())
        .map(|i| {
            let ray = scan.positions[i].coords.normalize();
            (f64::from(compensated[i] - raw[i]) - velocity.dot(&ray)).abs()
        })
        .collect();
    differences.sort_by(f64::total_cmp);
    // Of some 9 m/s.
    assert!(differences[differences.len() / 2] < 0.4, "{differences:?}");
}
