//! A small data set in MAN TruckScenes' layout: a lorry in a bend among boxes that stand still, as six radars, six LiDARs
//! and four cameras see it.

#[path = "world.rs"]
pub(crate) mod world;

use nalgebra::{Isometry3, Quaternion, Translation3, UnitQuaternion};
use serde_json::{Value, json};
use std::collections::HashMap;
use std::fs;
use std::path::Path;
use world::{T0, start_from_vehicle};

pub(crate) const SCENE: &str = "scene-0044384af3d8494e913fb8b14915239e-11";
pub(crate) const VERSION: &str = "v1.2-mini";
/// Between two scans of a sensor, us; every fifth is a keyframe.
const STEP: i64 = 100_000;
/// A grey image of 8 x 4 px.
const JPEG: &str = "ffd8ffe000104a46494600010100000100010000ffdb0043001b12141714111b1716171e1c1b2028422b28252528513a3d30\
    42605565645f555d5b6a7899816a7190735b5d85b586909ea3abadab6780bcc9baa6c799a8aba4ffc0000b08000400080101\
    1100ffc40014000100000000000000000000000000000003ffc4001810000203000000000000000000000000000003040553\
    ffda0008010100003f007455c4ccffd9";

/// How much there is of it.
#[derive(Clone, Copy)]
pub(crate) struct Shape {
    /// Scans of each radar and LiDAR.
    pub(crate) scans: i64,
    /// Azimuths and beams of a LiDAR's revolution.
    pub(crate) rays: [usize; 2],
    /// Rays of a radar's scan.
    pub(crate) detections: usize,
}

/// As small as can be.
pub(crate) const TINY: Shape = Shape { scans: 3, rays: [24, 4], detections: 12 };

/// The sensors: channel, kind, place, yaw and pitch in degrees (down is positive).
pub(crate) const SENSORS: [(&str, &str, [f64; 3], [f64; 2]); 16] = [
    ("RADAR_LEFT_BACK", "radar", [4.9, 1.25, 2.2], [160.0, 0.0]),
    ("RADAR_LEFT_FRONT", "radar", [5.259, 1.2266, 2.0126], [19.6, 0.0]),
    ("RADAR_LEFT_SIDE", "radar", [5.0, 1.3, 2.1], [90.0, 0.0]),
    ("RADAR_RIGHT_BACK", "radar", [4.9, -1.25, 2.2], [-160.0, 0.0]),
    ("RADAR_RIGHT_FRONT", "radar", [5.259, -1.2266, 2.0126], [-19.6, 0.0]),
    ("RADAR_RIGHT_SIDE", "radar", [5.0, -1.3, 2.1], [-90.0, 0.0]),
    ("LIDAR_LEFT", "lidar", [5.1, 1.3, 2.5], [45.0, 0.0]),
    ("LIDAR_RIGHT", "lidar", [5.1, -1.3, 2.5], [-45.0, 0.0]),
    ("LIDAR_TOP_FRONT", "lidar", [5.4, 0.0, 3.4], [0.0, 8.0]),
    ("LIDAR_TOP_LEFT", "lidar", [5.0, 1.2, 3.5], [80.0, 15.0]),
    ("LIDAR_TOP_RIGHT", "lidar", [5.0, -1.2, 3.5], [-80.0, 15.0]),
    ("LIDAR_REAR", "lidar", [-1.2, 0.0, 2.4], [180.0, 5.0]),
    ("CAMERA_LEFT_BACK", "camera", [5.1, 1.4, 2.3], [150.0, 0.0]),
    ("CAMERA_LEFT_FRONT", "camera", [5.4, 1.0, 2.4], [15.0, 0.0]),
    ("CAMERA_RIGHT_BACK", "camera", [5.1, -1.4, 2.3], [-150.0, 0.0]),
    ("CAMERA_RIGHT_FRONT", "camera", [5.4, -1.0, 2.4], [-15.0, 0.0]),
];

/// Writes the data set into this folder.
pub(crate) fn write_data_set(folder: &Path, shape: &Shape) {
    let mut data = Vec::new();
    for (place, (channel, kind, ..)) in SENSORS.iter().enumerate() {
        for scan in 0..shape.scans {
            let us = T0 + scan * STEP + 3_100 * place as i64;
            let part = if scan % 5 == 0 { "samples" } else { "sweeps" };
            let (format, bytes) = match *kind {
                "radar" => ("pcd", radar_file(&mounting(place), us, shape)),
                "lidar" => ("pcd", lidar_file(&mounting(place), us, shape)),
                _ => ("jpg", picture()),
            };
            let file = format!("{part}/{channel}/{channel}_{us}.{format}");
            write(&folder.join(&file), bytes);
            data.push(sample_data([place, scan as usize], us, file, format));
        }
    }
    let table = |name: &str, rows: Value| write(&folder.join(VERSION).join(name), rows.to_string());
    table("sample_data.json", data.into());
    sensor_tables(&table);
    scene_tables(&table, shape);
    motion_tables(&table, shape);
    for name in ["attribute", "category", "instance", "sample_annotation", "visibility", "weather_annotation"]
    {
        table(&format!("{name}.json"), json!([]));
    }
}

/// Which detections of a radar's scan are of something, in their order.
pub(crate) fn truth(radar: usize, scan: i64, shape: &Shape) -> Vec<bool> {
    let place = SENSORS.iter().position(|(channel, ..)| *channel == RADARS[radar]).unwrap();
    let us = T0 + scan * STEP + 3_100 * place as i64;
    world::detections(&mounting(place), us, shape.detections)
        .iter()
        .map(|detection| detection.is_real)
        .collect()
}

/// The radars in the order of a rig, which goes from the front to the back.
pub(crate) const RADARS: [&str; 6] = [
    "RADAR_LEFT_FRONT",
    "RADAR_RIGHT_FRONT",
    "RADAR_LEFT_SIDE",
    "RADAR_RIGHT_SIDE",
    "RADAR_LEFT_BACK",
    "RADAR_RIGHT_BACK",
];

/// A row's key.
fn token(table: u8, row: usize) -> String {
    format!("{table:02x}{row:030x}")
}

fn mounting(place: usize) -> Isometry3<f64> {
    let (_, _, translation, [yaw, pitch]) = SENSORS[place];
    let turn = UnitQuaternion::from_euler_angles(0.0, pitch.to_radians(), yaw.to_radians());
    Isometry3::from_parts(Translation3::from(translation), turn)
}

fn sample_data([place, scan]: [usize; 2], us: i64, file: String, format: &str) -> Value {
    let is_camera = format == "jpg";
    let [width, height] = if is_camera { [8, 4] } else { [800, 1] };
    // The nearest pose, which is not one of this time.
    json!({"token": token(1, 1000 * place + scan), "sample_token": token(2, 0), "ego_pose_token": token(5, scan * 10),
           "calibrated_sensor_token": token(3, place), "timestamp": us, "fileformat": format, "filename": file,
           "is_key_frame": scan % 5 == 0, "width": width, "height": height, "prev": "", "next": ""})
}

fn sensor_tables(table: &dyn Fn(&str, Value)) {
    let (mut sensors, mut mounted) = (Vec::new(), Vec::new());
    for (place, (channel, kind, translation, _)) in SENSORS.iter().enumerate() {
        // Cameras look along their z axis.
        let optical = UnitQuaternion::from_quaternion(Quaternion::new(0.5, -0.5, 0.5, -0.5));
        let is_camera = *kind == "camera";
        let turn = mounting(place).rotation * if is_camera { optical } else { UnitQuaternion::identity() };
        let lens = json!([[6.5, 0.0, 3.5], [0.0, 6.5, 1.5], [0.0, 0.0, 1.0]]);
        sensors.push(json!({"token": token(4, place), "channel": channel, "modality": kind}));
        mounted.push(
            json!({"token": token(3, place), "sensor_token": token(4, place), "translation": translation,
                            "rotation": [turn.w, turn.i, turn.j, turn.k],
                            "camera_intrinsic": if is_camera { lens } else { json!([]) }}),
        );
    }
    for (n, channel) in ["XSENSE_CABIN", "XSENSE_CHASSIS"].into_iter().enumerate() {
        sensors.push(json!({"token": token(4, 16 + n), "channel": channel, "modality": "imu"}));
        mounted.push(
            json!({"token": token(3, 16 + n), "sensor_token": token(4, 16 + n), "translation": [0, 0, 1],
                            "rotation": [1, 0, 0, 0], "camera_intrinsic": []}),
        );
    }
    table("sensor.json", sensors.into());
    table("calibrated_sensor.json", mounted.into());
}

fn scene_tables(table: &dyn Fn(&str, Value), shape: &Shape) {
    let scene = json!({"token": token(6, 0), "name": SCENE, "description": "weather.clear|area.highway", "log_token": "",
                       "nbr_samples": shape.scans, "first_sample_token": token(2, 0), "last_sample_token": token(2, 0)});
    table("scene.json", json!([scene]));
    let sample =
        json!({"token": token(2, 0), "timestamp": T0, "scene_token": token(6, 0), "prev": "", "next": ""});
    table("sample.json", json!([sample]));
}

/// Every 10 ms from half a second before the first scan to half a second after the last, and another day's.
fn motion_tables(table: &dyn Fn(&str, Value), shape: &Shape) {
    let count = (shape.scans * STEP + 1_000_000) / 10_000;
    let turn = UnitQuaternion::from_euler_angles(0.0, 0.0, 0.7);
    let utm_from_start = Isometry3::from_parts(Translation3::new(691_234.5, 5_334_000.25, 0.0), turn);
    let pose = |row: usize, us: i64, place: &Isometry3<f64>| {
        let (t, r) = (place.translation.vector, place.rotation);
        json!({"token": token(5, row), "timestamp": us, "translation": [t.x, t.y, t.z], "rotation": [r.w, r.i, r.j, r.k]})
    };
    let motion = |row: usize, us: i64, vx: f64| {
        json!({"token": token(7, row), "timestamp": us, "vx": vx, "vy": 0, "vz": 0, "ax": 0, "ay": 0, "az": 9.81, "yaw": 0,
               "pitch": 0, "roll": 0, "yaw_rate": world::YAW_RATE, "pitch_rate": 0, "roll_rate": 0})
    };
    let stamp = |row: i64| T0 - 497_000 + 10_000 * row;
    let rows = || (0..count).map(|row| (row as usize, stamp(row)));
    let mut poses: Vec<Value> =
        rows().map(|(row, us)| pose(row, us, &(utm_from_start * start_from_vehicle(us)))).collect();
    poses.push(pose(poses.len(), T0 + 86_400_000_000, &Isometry3::identity()));
    table("ego_pose.json", poses.into());
    table("ego_motion_cabin.json", rows().map(|(row, us)| motion(row, us, world::SPEED)).collect());
    table("ego_motion_chassis.json", rows().map(|(row, us)| motion(row, us, 1.01 * world::SPEED)).collect());
}

fn radar_file(mounting: &Isometry3<f64>, us: i64, shape: &Shape) -> Vec<u8> {
    let detections = world::detections(mounting, us, shape.detections);
    let column = |value: &dyn Fn(&world::Detection) -> f64| -> Vec<u8> {
        detections.iter().flat_map(|detection| (value(detection) as f32).to_le_bytes()).collect()
    };
    let axis = |axis: usize| move |detection: &world::Detection| detection.place[axis];
    let rate = |axis: usize| move |detection: &world::Detection| detection.velocity[axis];
    let mut columns: Vec<Vec<u8>> = (0..3).map(|n| column(&axis(n))).collect();
    columns.extend((0..3).map(|n| column(&rate(n))));
    columns.push(column(&|_| 7.5));
    pcd(
        "x y z vrel_x vrel_y vrel_z rcs",
        "4 4 4 4 4 4 4",
        "F F F F F F F",
        detections.len(),
        &columns.concat(),
    )
}

fn lidar_file(mounting: &Isometry3<f64>, us: i64, shape: &Shape) -> Vec<u8> {
    let points = world::revolution(mounting, us, shape.rays);
    let mut body = Vec::new();
    for axis in 0..3 {
        body.extend(points.iter().flat_map(|(place, _)| (place[axis] as f32).to_le_bytes()));
    }
    body.extend(points.iter().flat_map(|_| 12.0f32.to_le_bytes()));
    body.extend(points.iter().flat_map(|(_, us)| us.cast_unsigned().to_le_bytes()));
    pcd("x y z intensity timestamp", "4 4 4 4 8", "F F F F U", points.len(), &body)
}

/// A compressed file of these values, field by field.
fn pcd(fields: &str, sizes: &str, kinds: &str, points: usize, body: &[u8]) -> Vec<u8> {
    let counts = fields.split(' ').map(|_| "1").collect::<Vec<_>>().join(" ");
    let header = format!(
        "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS {fields}\nSIZE {sizes}\nTYPE {kinds}\nCOUNT {counts}\n\
         WIDTH {points}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS {points}\nDATA binary_compressed\n"
    );
    let packed = lzf(body);
    let sizes = [packed.len() as u32, body.len() as u32].map(u32::to_le_bytes).concat();
    [header.as_bytes(), &sizes, &packed].concat()
}

/// LZF: what came before within 8192 bytes is told by its distance.
fn lzf(bytes: &[u8]) -> Vec<u8> {
    let (mut packed, mut new) = (Vec::new(), Vec::new());
    let flush = |new: &mut Vec<u8>, packed: &mut Vec<u8>| {
        for run in new.chunks(32) {
            packed.push(run.len() as u8 - 1);
            packed.extend(run);
        }
        new.clear();
    };
    let mut seen: HashMap<&[u8], usize> = HashMap::new();
    let mut at = 0;
    while at < bytes.len() {
        let before = bytes.get(at..at + 3).and_then(|next| seen.insert(next, at));
        let Some(before) = before.filter(|before| at - before <= 8192) else {
            new.push(bytes[at]);
            at += 1;
            continue;
        };
        flush(&mut new, &mut packed);
        let same = bytes[before..].iter().zip(&bytes[at..]).take(264).take_while(|(a, b)| a == b).count();
        let (length, back) = (same - 2, at - before - 1);
        packed.push((length.min(7) << 5 | back >> 8) as u8);
        if length >= 7 {
            packed.push((length - 7) as u8);
        }
        packed.push((back & 255) as u8);
        at += same;
    }
    flush(&mut new, &mut packed);
    packed
}

fn picture() -> Vec<u8> {
    let value = |digit: u8| (digit as char).to_digit(16).unwrap() as u8;
    JPEG.as_bytes().chunks(2).map(|pair| value(pair[0]) << 4 | value(pair[1])).collect()
}

fn write(file: &Path, bytes: impl AsRef<[u8]>) {
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, bytes).unwrap();
}
