//! A small data set in nuScenes' layout, made here, and the genuine scene-0061 where it is at hand.

mod genuine;
mod reading;
mod refusals;

use super::*;
use crate::read::SequenceReader;
use crate::read::scene_tables::TableOrigin;
use crate::read::scene_tables::testing::{Tables, check_empty_scene, check_filenames, check_versions};
use crate::testing;
use ralf::sensors::Intrinsics;
use ralf::space::Point;
use serde_json::{Value, json};
use std::fs;
use tempfile::TempDir;

/// Microseconds of the first measurement.
const T0: i64 = 1_532_402_927_600_000;
const MS: i64 = 1000;
const VERSION: &str = "v1.0-test";
/// No turn, w x y z.
const AHEAD: [f64; 4] = [1.0, 0.0, 0.0, 0.0];

const HEADER: &str = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n\
    FIELDS x y z dyn_prop id rcs vx vy vx_comp vy_comp is_quality_valid ambig_state x_rms y_rms \
    invalid_state pdh0 vx_rms vy_rms\n\
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

impl Tables for DataSet {
    const VERSION: &'static str = VERSION;
    const SCENE: &'static str = "scene-0001";

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

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn open(&self) -> Result<Box<dyn SequenceReader>, DataError> {
        let mut recording = open(self.path(), &[])?;
        assert_eq!(recording.format, "nuscenes");
        Ok(recording.sequences.remove(0))
    }
}

impl DataSet {
    fn write_tables(&self) {
        self.write_sensors();
        self.table(
            "log",
            json!([{"token": "l", "location": "boston", "date_captured": "2018-07-24", "vehicle": "n"}]),
        );
        self.table(
            "scene",
            json!([{"token": "s", "log_token": "l", "name": "scene-0001", "description": "Turn", "nbr_samples": 1}]),
        );
        self.table("sample", json!([{"token": "x", "scene_token": "s", "timestamp": T0}]));
        self.write_measurements();
        let can = |ms: i64, v: f64| {
            json!({"utime": T0 + ms * MS, "vel": [v, 0.0, 0.0],
                   "rotation_rate": [9.0, 9.0, 0.25], "pos": [0, 0, 0]})
        };
        let rows = json!([can(20, 10.0), can(0, 9.0)]);
        self.write("can_bus/scene-0001_pose.json", rows.to_string().as_bytes());
    }

    fn write_sensors(&self) {
        let sensor = |channel: &str, modality: &str| {
            json!({"modality": modality, "token": channel,
                   "channel": channel})
        };
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
                mounted("RADAR_FRONT", AHEAD, json!([])),
                mounted("RADAR_BACK_LEFT", [half, 0.0, 0.0, half], json!([])),
                mounted("LIDAR_TOP", AHEAD, json!([])),
                mounted("CAM_FRONT", AHEAD, json!([[10.0, 0.0, 1.5], [0.0, 11.0, 0.5], [0.0, 0.0, 1.0]]))
            ]),
        );
    }

    fn write_measurements(&self) {
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
            json!({"token": format!("{ms}"), "timestamp": T0 + ms * MS, "rotation": AHEAD,
                   "translation": [0.01 * *ms as f64, 7.0, 0.0]})
        });
        self.table("ego_pose", poses.collect());
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
}
