//! A recording in nuScenes' tables, as small as one can be, whose names can be chosen.

use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Microseconds of the first measurement.
const T0: i64 = 1_532_402_927_600_000;

const RADAR_HEADER: &str = "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n\
    FIELDS x y z dyn_prop id rcs vx vy vx_comp vy_comp is_quality_valid ambig_state x_rms y_rms invalid_state pdh0 vx_rms vy_rms\n\
    SIZE 4 4 4 1 2 4 4 4 4 4 1 1 1 1 1 1 1 1\nTYPE F F F I I F F F F F I I I I I I I I\n\
    COUNT 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1 1\nWIDTH 1\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA binary\n";

/// Writes a scene of this name with a radar of this channel and a LiDAR below `folder`.
pub(crate) fn write_nuscenes(folder: &Path, scene: &str, channel: &str) {
    let table =
        |name: &str, rows: Value| put(folder, &format!("v1.0-test/{name}.json"), rows.to_string().as_bytes());
    let sensors = [("r", channel, "radar"), ("l", "LIDAR_TOP", "lidar")];
    let sensor = |(token, channel, modality): (&str, &str, &str)| json!({"token": token, "channel": channel, "modality": modality});
    table("sensor", sensors.into_iter().map(sensor).collect());
    let mounted = |(token, ..): (&str, &str, &str)| {
        json!({"token": format!("cs-{token}"), "sensor_token": token, "translation": [3.0, 1.0, 0.5],
               "rotation": [1.0, 0.0, 0.0, 0.0], "camera_intrinsic": []})
    };
    table("calibrated_sensor", sensors.into_iter().map(mounted).collect());
    table(
        "log",
        json!([{"token": "g", "location": "boston", "date_captured": "2018-07-24", "vehicle": "n"}]),
    );
    table(
        "scene",
        json!([{"token": "s", "log_token": "g", "name": scene, "description": "", "nbr_samples": 1}]),
    );
    table("sample", json!([{"token": "x", "scene_token": "s", "timestamp": T0}]));
    let data = |(token, file, ms): (&str, &str, i64)| {
        json!({"token": format!("data-{token}"), "sample_token": "x", "ego_pose_token": token, "is_key_frame": true,
               "calibrated_sensor_token": format!("cs-{token}"), "timestamp": T0 + ms * 1000, "filename": file,
               "width": 0, "height": 0, "fileformat": "", "prev": "", "next": ""})
    };
    let files = [("r", "samples/radar.pcd", 0), ("l", "samples/lidar.pcd.bin", 20)];
    table("sample_data", files.into_iter().map(data).collect());
    let pose = |(token, _, ms): (&str, &str, i64)| {
        json!({"token": token, "timestamp": T0 + ms * 1000, "rotation": [1.0, 0.0, 0.0, 0.0],
               "translation": [0.01 * ms as f64, 0.0, 0.0]})
    };
    table("ego_pose", files.into_iter().map(pose).collect());
    let mut radar = RADAR_HEADER.as_bytes().to_vec();
    radar.extend([3.0_f32, 4.0, 0.0].iter().flat_map(|value| value.to_le_bytes()));
    radar.extend([3, 1, 0]);
    radar.extend([7.5_f32, 1.0, 2.0, 0.0, 0.0].iter().flat_map(|value| value.to_le_bytes()));
    radar.extend([1, 3, 20, 21, 0, 2, 0, 5]);
    put(folder, "samples/radar.pcd", &radar);
    let lidar: Vec<u8> =
        [1.0_f32, 2.0, 3.0, 200.0, 31.0].iter().flat_map(|value| value.to_le_bytes()).collect();
    put(folder, "samples/lidar.pcd.bin", &lidar);
}

fn put(folder: &Path, name: &str, bytes: &[u8]) {
    let file = folder.join(name);
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, bytes).unwrap();
}
