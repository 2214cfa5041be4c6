//! A small recording in aiMotive's layout: posts beside a bend that is driven through at 20 m/s.

use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion, Vector3};
use serde_json::{Value, json};
use std::fs;
use std::io::Cursor;
use std::path::Path;

pub(crate) const SEQUENCE: &str = "20210901-194123-00.00.10-00.00.25@Yoda";
/// Numbers of the frames.
pub(crate) const FRAMES: [u64; 4] = [33643, 33644, 33645, 33646];
/// Time of the first frame, ns.
pub(crate) const T0: i64 = 4_833_189_570_000;
/// Between two frames, ns.
pub(crate) const STEP: i64 = 66_660_000;
/// Posts, in the vehicle's frame at the first frame's time, m.
pub(crate) const POSTS: [[f64; 3]; 5] =
    [[20.0, 4.0, 1.0], [35.0, -6.0, 0.8], [-25.0, 3.0, 1.2], [60.0, 8.0, 0.5], [5.0, -9.0, 2.0]];
/// When a post is measured, ns after the frame.
pub(crate) const POINT_TIMES: [i64; 5] = [-67_000_000, -40_000_000, -1_000_000, 10_000_000, 33_000_000];

/// When a frame was, ns.
pub(crate) fn frame_time(index: usize) -> i64 {
    T0 + index as i64 * STEP
}

/// The vehicle at a time, in its frame at the first: 20 m/s and 0.3 rad/s to the left.
pub(crate) fn start_from_vehicle(t_ns: i64) -> Isometry3<f64> {
    let (speed, yaw_rate) = (20.0, 0.3);
    let turned = yaw_rate * (t_ns - T0) as f64 * 1e-9;
    let radius = speed / yaw_rate;
    let place = Translation3::new(radius * turned.sin(), radius * (1.0 - turned.cos()), 0.0);
    Isometry3::from_parts(place, UnitQuaternion::from_axis_angle(&Vector3::z_axis(), turned))
}

/// Writes the sequence into this folder: two radars, a LiDAR, calibration of two cameras, boxes and poses.
pub(crate) fn write_sequence(folder: &Path) {
    let put = |name: &str, value: Value| write(&folder.join(name), value.to_string());
    put("sensor/calibration/calibration.json", calibration());
    let mut poses = serde_json::Map::new();
    for (index, frame) in FRAMES.into_iter().enumerate() {
        let t_ns = frame_time(index);
        for radar in ["F_LRR_C", "B_LRR_C"] {
            put(&format!("sensor/radar/{radar}/{radar}_{frame:07}.json"), targets());
        }
        let boxes = json!({"CapturedObjects": [], "Timestamp": t_ns.to_string()});
        put(&format!("dynamic/box/3d_body/frame_{frame:07}.json"), boxes);
        write(&folder.join(format!("dynamic/raw-revolutions/frame_{frame:07}.laz")), revolution(t_ns));
        poses.insert(format!("{frame:07}"), matrix(&(earth_from_start() * start_from_vehicle(t_ns))));
    }
    put("sensor/gnssins/egomotion.json", poses.into());
}

/// Somewhere on the earth, seven digits before the point.
fn earth_from_start() -> Isometry3<f64> {
    let turn = UnitQuaternion::from_euler_angles(0.4, 0.7, -1.9);
    Isometry3::from_parts(Translation3::new(4_080_123.25, 1_411_987.5, 4_677_000.75), turn)
}

fn matrix(transform: &Isometry3<f64>) -> Value {
    let m = transform.to_homogeneous();
    (0..4).map(|row| (0..4).map(|column| m[(row, column)]).collect::<Vec<f64>>()).collect::<Vec<_>>().into()
}

/// The front radar looks ahead, the rear one back; one camera is a pinhole, the other a fisheye.
fn calibration() -> Value {
    let mounted = |kind: &str, place: [f64; 3], turn: UnitQuaternion<f64>| {
        let pose = Isometry3::from_parts(Translation3::from(place), turn);
        json!({"sensor_type": kind, "RT_body_from_sensor": matrix(&pose), "custom_vars": {"rpm": "nan"}})
    };
    let yaw = |degrees: f64| UnitQuaternion::from_axis_angle(&Vector3::z_axis(), degrees.to_radians());
    let optical = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(0.5, -0.5, 0.5, -0.5));
    let lens = |model: &str| {
        let mut camera = mounted("camera", [1.9, 0.1, 1.25], optical);
        camera["model"] = model.into();
        camera["image_resolution_px"] = json!([8, 4]);
        camera["focal_length_px"] = json!([6.5, 6.25]);
        camera["principal_point_px"] = json!([4.0, 2.0]);
        camera["distortion_coeffs"] = json!([-0.3, 0.08, 0.002, 0.0006, 0]);
        camera
    };
    json!({
        "F_LRR_C": mounted("radar", [3.8, 0.0, 0.4], yaw(0.0)),
        "B_LRR_C": mounted("radar", [-1.1, 0.0, 0.55], yaw(180.0)),
        "M_LIDAR_M": mounted("lidar", [1.16, 0.0, 1.68], yaw(88.7)),
        "F_MIDLONGRANGECAM_CL": lens("opencv_pinhole"),
        "M_FISHEYE_L": lens("mei"),
        "novatel": {"sensor_type": "gps_ins"},
    })
}

fn targets() -> Value {
    let target = |azimuth: f64, range: f64, speed: f64, rcs: f64| {
        json!({"azimuth": azimuth, "elevation": 0.01, "range": range, "speed": speed, "rcs": rcs, "power": 130.5,
               "noise": 104.0})
    };
    json!({"id": "?", "targets": [target(0.15, 21.5, -19.75, 2.0), target(-0.1, 48.0, -19.9, 100.0)]})
}

/// The posts, each seen from where the vehicle then was, and a beam that came back from nothing.
fn revolution(t_ns: i64) -> Vec<u8> {
    let mut points = Vec::new();
    for (post, after) in POSTS.into_iter().zip(POINT_TIMES) {
        let seen = start_from_vehicle(t_ns + after).inverse() * Point3::from(post);
        points.push((seen, t_ns + after));
    }
    // The LiDAR's own place, rounded: what a return of range 0 becomes.
    points.push((Point3::new(1.16, 0.0, 1.68), t_ns));
    laz(&points)
}

/// A LAZ file of LAS 1.2, point format 1.
pub(crate) fn laz(points: &[(Point3<f64>, i64)]) -> Vec<u8> {
    let mut header = las::Builder::from((1, 2));
    header.point_format = las::point::Format::new(1).unwrap();
    header.point_format.is_compressed = true;
    let mut writer = las::Writer::new(Cursor::new(Vec::new()), header.into_header().unwrap()).unwrap();
    for (n, (place, t_ns)) in points.iter().enumerate() {
        let gps_time = Some(*t_ns as f64);
        let point = las::Point {
            x: place.x,
            y: place.y,
            z: place.z,
            intensity: n as u16,
            gps_time,
            ..Default::default()
        };
        writer.write_point(point).unwrap();
    }
    writer.close().unwrap();
    writer.into_inner().unwrap().into_inner()
}

fn write(file: &Path, bytes: impl AsRef<[u8]>) {
    fs::create_dir_all(file.parent().unwrap()).unwrap();
    fs::write(file, bytes).unwrap();
}
