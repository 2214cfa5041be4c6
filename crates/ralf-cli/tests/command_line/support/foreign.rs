//! Small recordings in the formats of others, made here: what a radar and a LiDAR saw of a wall, five times.

use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const SCANS: i64 = 5;
/// Microseconds of the first measurement.
const T0: i64 = 1_532_402_927_600_000;
const FIELDS: &str = "x y z dyn_prop id rcs vx vy vx_comp vy_comp is_quality_valid ambig_state x_rms y_rms invalid_state pdh0 vx_rms vy_rms";

/// A scene `scene-0001` of nuScenes with the radar `RADAR_FRONT`.
pub(crate) fn nuscenes(folder: &Path) {
    nuscenes_named(folder, "scene-0001", "RADAR_FRONT");
}

/// The same scene under another name, with a radar of another channel.
pub(crate) fn nuscenes_named(folder: &Path, scene: &str, channel: &str) {
    let table = |name: &str, rows: Value| write(&folder.join("v1.0-test").join(name), rows.to_string());
    let sensor = |token: &str, channel: &str, modality: &str| json!({"token": token, "channel": channel, "modality": modality});
    let sensors = [sensor("RADAR_FRONT", channel, "radar"), sensor("LIDAR_TOP", "LIDAR_TOP", "lidar")];
    table("sensor.json", json!(sensors));
    let turn = [1.0, 0.0, 0.0, 0.0];
    let mounted = |name: &str, z: f64| {
        json!({"token": format!("at-{name}"), "sensor_token": name, "translation": [1.0, 0.0, z], "rotation": turn,
               "camera_intrinsic": []})
    };
    table("calibrated_sensor.json", json!([mounted("RADAR_FRONT", 0.5), mounted("LIDAR_TOP", 1.8)]));
    table("log.json", json!([{"token": "l", "location": "here", "date_captured": "2018-07-24"}]));
    let scene = json!([{"token": "s", "log_token": "l", "name": scene, "description": "a wall"}]);
    table("scene.json", scene);
    table("sample.json", json!([{"token": "x", "scene_token": "s"}]));
    let (mut data, mut poses) = (Vec::new(), Vec::new());
    for scan in 0..SCANS {
        let time = T0 + scan * 75_000;
        let radar = format!("samples/RADAR_FRONT/{scan}.pcd");
        let lidar = format!("samples/LIDAR_TOP/{scan}.pcd.bin");
        write(&folder.join(&radar), pcd(&wall(12)));
        write(&folder.join(&lidar), rows(&wall(200), 5));
        for (name, file) in [("RADAR_FRONT", radar), ("LIDAR_TOP", lidar)] {
            data.push(json!({"token": format!("data-{name}-{scan}"), "sample_token": "x", "ego_pose_token": format!("p{scan}"), "filename": file,
                "calibrated_sensor_token": format!("at-{name}"), "timestamp": time, "width": 0, "height": 0}));
        }
        poses.push(json!({"token": format!("p{scan}"), "timestamp": time, "rotation": turn, "translation": [0.1 * scan as f64, 0.0, 0.0]}));
    }
    table("sample_data.json", data.into());
    table("ego_pose.json", poses.into());
}

/// The frames 5 to 9 of View-of-Delft.
pub(crate) fn view_of_delft(folder: &Path) {
    let calib = |at: &str| {
        format!(
            "P2: 50 0 2 0 0 50 1 0 0 0 1 0\nR0_rect: 1 0 0 0 1 0 0 0 1\nTr_velo_to_cam: 0 -1 0 0 0 0 -1 {at}\n"
        )
    };
    for frame in 5..5 + SCANS {
        let put = |place: &str, bytes: Vec<u8>| {
            write(&folder.join(place.replace('*', &format!("{frame:05}"))), bytes);
        };
        put("radar/training/velodyne/*.bin", rows(&wall(12), 7));
        put("lidar/training/velodyne/*.bin", rows(&wall(200), 4));
        put("radar/training/calib/*.txt", calib("1.1 1 0 0 2.5").into());
        put("lidar/training/calib/*.txt", calib("0 1 0 0 0").into());
        let x = 0.1 * frame as f64;
        let pose = format!("{{\"odomToCamera\": [0, 0, 1, {x}, -1, 0, 0, 0, 0, -1, 0, 1.49, 0, 0, 0, 1]}}");
        put("radar/training/pose/*.json", pose.into());
    }
}

/// Points of a wall ahead.
fn wall(points: usize) -> Vec<[f32; 3]> {
    (0..points)
        .map(|n| [20.0, -5.0 + 10.0 * n as f32 / points as f32, 0.2 + 0.01 * (n % 50) as f32])
        .collect()
}

/// Rows of float32 that begin with a place; all else is 0.
fn rows(points: &[[f32; 3]], columns: usize) -> Vec<u8> {
    let mut bytes = Vec::new();
    for point in points {
        let mut row = vec![0.0; columns];
        row[..3].copy_from_slice(point);
        bytes.extend(row.into_iter().flat_map(f32::to_le_bytes));
    }
    bytes
}

fn pcd(points: &[[f32; 3]]) -> Vec<u8> {
    let columns = FIELDS.split(' ').count();
    let each = |value: &str| vec![value; columns].join(" ");
    let (size, kind, count, n) = (each("4"), each("F"), each("1"), points.len());
    let head = format!(
        "VERSION 0.7\nFIELDS {FIELDS}\nSIZE {size}\nTYPE {kind}\nCOUNT {count}\nWIDTH {n}\nHEIGHT 1\n\
         VIEWPOINT 0 0 0 1 0 0 0\nPOINTS {n}\nDATA binary\n"
    );
    [head.into_bytes(), rows(points, columns)].concat()
}

fn write(file: &Path, bytes: impl AsRef<[u8]>) {
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, bytes).unwrap();
}
