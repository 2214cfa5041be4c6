//! Rigid transforms and the camera out of KITTI's matrices.
//!
//! View-of-Delft gives no vehicle frame. Here it is the LiDAR's axes (x forward, y left, z up) with the origin on the
//! ground below the rear axle of the recording car, a Toyota Prius.

use super::raw::Calib;
use crate::error::DataError;
use crate::read::rotation::{mounting, rotation};
use nalgebra::{Matrix3, Translation3};
use ralf::sensors::{Camera, Intrinsics};
use ralf::space::Transform;
use std::path::Path;

/// The LiDAR ahead of the rear axle, m: the wheelbase (2.70) and the front overhang (0.93) reach the front bumper with
/// the radar in it, which the calibration puts 2.51 m ahead of the LiDAR.
const LIDAR_X: f64 = 2.70 + 0.93 - 2.51;
/// The LiDAR above the ground, m, measured by a plane fitted to the ground around the car.
const LIDAR_Z: f64 = 1.49;

/// Where the LiDAR sits.
pub(super) fn vehicle_from_lidar() -> Transform {
    Transform::translation(LIDAR_X, 0.0, LIDAR_Z)
}

/// What one frame's calibration files say.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mounting {
    pub(super) camera_from_radar: Transform,
    pub(super) camera_from_lidar: Transform,
}

impl Mounting {
    /// Whether two frames agree, within 1 mm and 0.01 deg.
    pub(super) fn agrees_with(&self, other: &Self) -> bool {
        let near = |a: &Transform, b: &Transform| {
            (a.translation.vector - b.translation.vector).norm() <= 1e-3
                && a.rotation.angle_to(&b.rotation) <= 0.01_f64.to_radians()
        };
        near(&self.camera_from_radar, &other.camera_from_radar)
            && near(&self.camera_from_lidar, &other.camera_from_lidar)
    }

    /// Extrinsics of the radar.
    pub(super) fn vehicle_from_radar(&self) -> Transform {
        vehicle_from_lidar() * self.camera_from_lidar.inv_mul(&self.camera_from_radar)
    }

    /// Extrinsics of the camera.
    pub(super) fn vehicle_from_camera(&self) -> Transform {
        vehicle_from_lidar() * self.camera_from_lidar.inverse()
    }
}

/// `R0_rect * Tr_velo_to_cam`: the folder's sensor in the rectified camera's frame.
pub(super) fn camera_from_sensor(file: &Path, calib: &Calib) -> Result<Transform, DataError> {
    let rectify = rotation(file, "R0_rect", Matrix3::from_row_slice(&calib.r0_rect))?;
    let [a, b, c, x, d, e, f, y, g, h, i, z] = calib.tr_velo_to_cam;
    let turn = rotation(file, "Tr_velo_to_cam", Matrix3::new(a, b, c, d, e, f, g, h, i))?;
    let camera_from_sensor = Transform::from_parts(Translation3::new(x, y, z), turn);
    Ok(rectify * mounting(file, "Tr_velo_to_cam", camera_from_sensor)?)
}

/// The pose of a frame's vehicle in odom, out of the matrix of its pose file.
pub(super) fn odom_from_vehicle(
    file: &Path,
    odom_from_camera: &[f64; 16],
    mounting: &Mounting,
) -> Result<Transform, DataError> {
    let [a, b, c, x, d, e, f, y, g, h, i, z, last @ ..] = *odom_from_camera;
    if last != [0.0, 0.0, 0.0, 1.0] {
        return Err(DataError::content(file, "odomToCamera", "a last row of 0 0 0 1", format!("{last:?}")));
    }
    let turn = rotation(file, "odomToCamera", Matrix3::new(a, b, c, d, e, f, g, h, i))?;
    let odom_from_camera = Transform::from_parts(Translation3::new(x, y, z), turn);
    Ok(odom_from_camera * mounting.vehicle_from_camera().inverse())
}

/// A pinhole without distortion, for the images are rectified: `P2` is `K [I | 0]`.
pub(super) fn camera(
    file: &Path,
    calib: &Calib,
    mounting: &Mounting,
    [width, height]: [usize; 2],
) -> Result<Camera, DataError> {
    let [fx, 0.0, cx, 0.0, 0.0, fy, cy, 0.0, 0.0, 0.0, 1.0, 0.0] = calib.p2 else {
        return Err(DataError::content(file, "P2", "fx 0 cx 0 0 fy cy 0 0 0 1 0", format!("{:?}", calib.p2)));
    };
    Ok(Camera {
        name: "camera".to_owned(),
        vehicle_from_camera: mounting.vehicle_from_camera(),
        width,
        height,
        intrinsics: Intrinsics::Pinhole { focal: [fx, fy], center: [cx, cy], distortion: [0.0; 5] },
        views: Vec::new(),
    })
}
