//! A small sequence in the layout of the Zenseact Open Dataset: posts beside a bend that is driven through at 18 m/s.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Unix time of the first frame, ns: 2022-02-14T13:23:32.251875Z.
pub(crate) const T0: i64 = 1_644_845_012_251_875_000;
pub(crate) const LIST: &str = "trainval-sequences-mini.json";
pub(crate) const FOLDER: &str = "sequences/000000";
/// Scans of the radar and how many detections each has; frames of LiDAR and camera.
pub(crate) const DETECTIONS: [usize; 4] = [3, 0, 5, 2];
pub(crate) const FRAMES: i64 = 3;
/// Posts, in the ego frame at the first frame's time, m.
pub(crate) const POSTS: [[f64; 3]; 4] =
    [[20.0, 4.0, 0.6], [35.0, -6.0, 0.5], [-25.0, 3.0, 0.9], [9.0, -9.0, 1.2]];
/// When a post is measured, us after the frame.
const POINT_TIMES: [i64; 4] = [-50_000, -20_000, 10_000, 49_000];

/// The ego frame at a time, in that at the first frame: 18 m/s and 0.25 rad/s to the left.
pub(crate) fn start_from_ego(t_ns: i64) -> Isometry3<f64> {
    let (speed, yaw_rate) = (18.0, 0.25);
    let turned = yaw_rate * (t_ns - T0) as f64 * 1e-9;
    let radius = speed / yaw_rate;
    let place = Translation3::new(radius * turned.sin(), radius * (1.0 - turned.cos()), 0.0);
    Isometry3::from_parts(place, UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turned))
}

/// When a frame was, as a text.
fn time(frame: i64) -> String {
    let us = 251_875 + 100_000 * frame;
    format!("2022-02-14T13:23:32.{us:06}Z")
}

/// Writes the list and the sequence.
pub(crate) fn write_data_set(folder: &Path) {
    let at = |name: &str| format!("{FOLDER}/{name}");
    let put = |name: &str, bytes: Vec<u8>| write(&folder.join(at(name)), bytes);
    let (mut lidars, mut cameras) = (Vec::new(), Vec::new());
    for frame in 0..FRAMES {
        let [lidar, camera] = ["lidar_velodyne", "camera_front_blur"].map(|sensor| {
            let ending = if sensor == "lidar_velodyne" { "npy" } else { "png" };
            format!("{sensor}/000000_quebec_{}.{ending}", time(frame))
        });
        put(&lidar, revolution(T0 + frame * 100_000_000));
        put(&camera, picture());
        lidars.push(json!({"filepath": at(&lidar), "time": time(frame), "is_compensated": false}));
        cameras.push(json!({"filepath": at(&camera), "time": time(frame), "height": 2, "width": 2}));
    }
    let radar = format!("radar_front/000000_quebec_{}.npy", time(0));
    put(&radar, scans());
    put("calibration.json", calibration().to_string().into());
    put("ego_motion.json", motion().to_string().into());
    let info = json!({
        "id": "000000", "start_time": time(0), "end_time": time(9), "keyframe_time": time(1),
        "calibration_path": at("calibration.json"), "ego_motion_path": at("ego_motion.json"),
        "metadata_path": at("metadata.json"), "oxts_path": at("oxts.hdf5"), "vehicle_data_path": null, "annotations": {},
        "camera_frames": {"front_blur": cameras}, "lidar_frames": {"velodyne": lidars},
        "radar_frames": {"front": [{"filepath": at(&radar), "time": time(0)}]},
    });
    let elsewhere = json!({"id": "000001", "calibration_path": "sequences/000001/calibration.json",
                           "ego_motion_path": "sequences/000001/ego_motion.json"});
    write(&folder.join(LIST), json!({"train": [info], "val": [elsewhere]}).to_string());
}

fn matrix(transform: &Isometry3<f64>) -> Value {
    let m = transform.to_homogeneous();
    (0..4).map(|row| (0..4).map(|column| m[(row, column)]).collect::<Vec<f64>>()).collect::<Vec<_>>().into()
}

/// The LiDAR looks to the right: its x axis is the vehicle's -y.
pub(crate) fn ego_from_lidar() -> Isometry3<f64> {
    let turn = UnitQuaternion::from_axis_angle(&Vector3::z_axis(), -std::f64::consts::FRAC_PI_2);
    Isometry3::from_parts(Translation3::new(1.2, 0.0, 1.7), turn)
}

fn calibration() -> Value {
    let optical = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(0.5, -0.5, 0.5, -0.5));
    let camera = Isometry3::from_parts(Translation3::new(1.9, 0.0, 1.1), optical);
    let radar = Isometry3::translation(3.9, 0.0, 0.2);
    json!({"FC": {
        "extrinsics": matrix(&camera), "lidar_extrinsics": matrix(&ego_from_lidar()), "radar_extrinsics": matrix(&radar),
        "intrinsics": [[1.5, 0.0, 0.5], [0.0, 1.5, 0.5], [0.0, 0.0, 1.0]], "distortion": [0.1, -0.02, 0.0, 0.0],
        "undistortion": [0, 0, 0, 0], "image_dimensions": [2, 2], "field_of_view": [120, 67],
    }})
}

/// Poses every 10 ms around the frames.
fn motion() -> Value {
    let times: Vec<i64> = (-20..60).map(|n| T0 + n * 10_000_000).collect();
    let poses: Vec<Value> = times.iter().map(|t_ns| matrix(&start_from_ego(*t_ns))).collect();
    let seconds: Vec<f64> = times.iter().map(|t_ns| *t_ns as f64 * 1e-9).collect();
    json!({"poses": poses, "timestamps": seconds, "velocities": [], "origin_lat_lon": [57.7, 11.9]})
}

/// The bytes of `np.save`.
pub(crate) fn npy(descr: &str, rows: usize, body: &[u8]) -> Vec<u8> {
    let dict = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': ({rows},), }}");
    let length = (dict.len() + 11).next_multiple_of(64) - 10;
    let head = format!("{dict:<width$}\n", width = length - 1);
    [b"\x93NUMPY\x01\x00", &(length as u16).to_le_bytes()[..], head.as_bytes(), body].concat()
}

/// All scans of the radar, 60 ms apart; a scan without detections has no rows.
fn scans() -> Vec<u8> {
    let mut body = Vec::new();
    for (scan, count) in DETECTIONS.into_iter().enumerate() {
        for n in 0..count {
            body.extend((scan as u32 + 7).to_le_bytes());
            body.extend((T0 + 60_000_000 * scan as i64).to_le_bytes());
            let azimuth = 0.1 * n as f32;
            for value in [20.0 + n as f32, azimuth, 0.02, -18.0 * azimuth.cos(), 12.5] {
                body.extend(value.to_le_bytes());
            }
            body.extend([(n % 2) as u8, 1, 2]);
        }
    }
    let descr = "[('scan_index', '<u4'), ('timestamp', '<i8'), ('radar_range', '<f4'), ('azimuth_angle', '<f4'), \
                 ('elevation_angle', '<f4'), ('range_rate', '<f4'), ('amplitude', '<f4'), ('validity', '|i1'), \
                 ('mode', '|u1'), ('quality', '|u1')]";
    npy(descr, DETECTIONS.iter().sum(), &body)
}

/// The posts, each seen from where the LiDAR then was, and the own roof.
fn revolution(t_ns: i64) -> Vec<u8> {
    let mut points: Vec<(Point3<f64>, i64)> = Vec::new();
    for (post, us) in POSTS.into_iter().zip(POINT_TIMES) {
        let start_from_lidar = start_from_ego(t_ns + us * 1000) * ego_from_lidar();
        points.push((start_from_lidar.inverse() * Point3::from(post), us));
    }
    points.push((Point3::new(0.5, 0.5, -0.3), 0));
    let mut body = Vec::new();
    for (n, (place, us)) in points.iter().enumerate() {
        body.extend([place.x, place.y, place.z].map(|v| (v as f32).to_le_bytes()).concat());
        body.extend(us.to_le_bytes());
        body.extend([n as u8, 128]);
    }
    let descr = "[('x', '<f4'), ('y', '<f4'), ('z', '<f4'), ('timestamp', '<i8'), ('intensity', '|u1'), \
                 ('diode_index', '|u1')]";
    npy(descr, points.len(), &body)
}

/// A PNG image of 2 x 2 px, black.
fn picture() -> Vec<u8> {
    const PNG: &str = "89504e470d0a1a0a0000000d494844520000000200000002080000000057dd52f80000000b49444154789c6360\
        00010000060001fe8c67c80000000049454e44ae426082";
    let value = |digit: u8| (digit as char).to_digit(16).unwrap() as u8;
    PNG.as_bytes().chunks(2).map(|pair| value(pair[0]) << 4 | value(pair[1])).collect()
}

fn write(file: &Path, bytes: impl AsRef<[u8]>) {
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, bytes).unwrap();
}
