//! The vehicle's sensors: a roof LiDAR, four radars, four fisheye cameras.

use nalgebra::{Quaternion, Translation3, UnitQuaternion};
use ralf::sensors::{Camera, Elevation, Intrinsics, Lidar, Radar, Reliability, Rig, View};
use ralf::space::Transform;

/// Width and height of images and straight views, px.
const IMAGE: (usize, usize) = (400, 260);
const VIEW: (usize, usize) = (480, 300);
const HALF_VIEW: (usize, usize) = (320, 320);

/// The whole rig.
pub(super) fn rig() -> Rig {
    let front_to_left = [("front", 0.0), ("left", 90.0), ("right", -90.0), ("rear", 180.0)];
    Rig {
        radars: front_to_left.map(|(side, yaw)| radar(side, yaw)).into(),
        lidars: vec![lidar()],
        cameras: front_to_left.map(|(side, yaw)| camera(side, yaw)).into(),
    }
}

fn turned(place: [f64; 3], yaw_deg: f64, pitch_deg: f64) -> Transform {
    let rotation = UnitQuaternion::from_euler_angles(0.0, pitch_deg.to_radians(), yaw_deg.to_radians());
    Transform::from_parts(Translation3::from(place), rotation)
}

/// A camera's mounting: it looks along its yaw, so many degrees down.
pub(super) fn camera_mounting(place: [f64; 3], yaw_deg: f64, down_deg: f64) -> Transform {
    let level_from_optical = UnitQuaternion::from_quaternion(Quaternion::new(0.5, -0.5, 0.5, -0.5));
    let pose = turned(place, yaw_deg, down_deg);
    Transform::from_parts(pose.translation, pose.rotation * level_from_optical)
}

fn radar(side: &str, yaw_deg: f64) -> Radar {
    let place = match side {
        "front" => [3.7, 0.0, 0.5],
        "left" => [2.6, 0.9, 0.5],
        "right" => [2.6, -0.9, 0.5],
        _ => [-0.9, 0.0, 0.5],
    };
    // Wide off its axis a radar measures worse; the table says so to whoever labels.
    let reliability = [(-80.0, 1.3), (-60.0, 1.0), (60.0, 1.0), (80.0, 1.3)];
    let reliability = reliability.map(|(azimuth, value): (f64, f64)| (azimuth.to_radians(), value));
    Radar {
        name: format!("radar_{side}"),
        fields: ["x", "y", "z", "doppler", "rcs"].map(str::to_owned).into(),
        vehicle_from_radar: turned(place, yaw_deg, 0.0),
        elevation: Elevation::Measured,
        fov_azimuth: 160.0_f64.to_radians(),
        fov_elevation: 20.0_f64.to_radians(),
        sigma_range: 0.1,
        sigma_azimuth: 0.6_f64.to_radians(),
        sigma_elevation: 1.5_f64.to_radians(),
        reliability: Reliability::new(reliability.into()).unwrap_or_default(),
    }
}

fn lidar() -> Lidar {
    Lidar {
        name: "lidar_top".into(),
        vehicle_from_lidar: turned([1.2, 0.0, 1.9], 0.0, 0.0),
        sigma_range: 0.03,
        lowest_beam: 16.0_f64.to_radians(),
        max_range: Some(120.0),
    }
}

fn camera(side: &str, yaw_deg: f64) -> Camera {
    // Those in the mirrors look along the flanks, too: two straight views instead of one.
    let (place, pitch_deg, yaws_deg): (_, f64, &[f64]) = match side {
        "front" => ([3.6, 0.0, 0.75], 12.0, &[0.0]),
        "left" => ([1.9, 1.0, 1.1], 18.0, &[40.0, -40.0]),
        "right" => ([1.9, -1.0, 1.1], 18.0, &[40.0, -40.0]),
        _ => ([-0.9, 0.0, 1.0], 12.0, &[0.0]),
    };
    let (size, fov_deg): ((usize, usize), f64) =
        if yaws_deg.len() == 1 { (VIEW, 110.0) } else { (HALF_VIEW, 84.0) };
    let (width, height) = IMAGE;
    // Turned up again, so that the horizon lies in the middle.
    let pitch = -pitch_deg.to_radians() * 0.7;
    let view = |yaw: &f64| View {
        yaw: yaw.to_radians(),
        pitch,
        horizontal_fov: fov_deg.to_radians(),
        width: size.0,
        height: size.1,
    };
    Camera {
        name: format!("camera_{side}"),
        vehicle_from_camera: camera_mounting(place, yaw_deg, pitch_deg),
        width,
        height,
        intrinsics: Intrinsics::KannalaBrandt {
            focal: [124.0; 2],
            center: [(width as f64 - 1.0) / 2.0 + 1.5, (height as f64 - 1.0) / 2.0 - 0.75],
            distortion: [0.03, -0.008, 0.0, 0.0],
        },
        views: yaws_deg.iter().map(view).collect(),
    }
}

/// Elevations of the LiDAR's channels, rad, from the lowest up: 40, a third of a degree apart about the horizon and a
/// degree beyond.
pub(super) fn lidar_channels() -> Vec<f64> {
    let lowest = (0..10).map(|i| -16.0 + f64::from(i));
    let middle = (0..25).map(|i| -6.0 + f64::from(i) / 3.0);
    let top = (0..5).map(|i| 3.0 + f64::from(i));
    lowest.chain(middle).chain(top).map(f64::to_radians).collect()
}
