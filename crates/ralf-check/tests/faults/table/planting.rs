//! How a fault comes into a recording.

use super::MS;
use crate::recording::Planted;
use nalgebra::UnitQuaternion;
use ralf::space::Transform;
use ralf_check::SensorChange;

pub(super) fn turned(p: &mut Planted, radar: usize, roll: f64, pitch: f64, yaw: f64) {
    let mount = &mut p.sequence.rig.radars[radar].vehicle_from_radar;
    let [roll, pitch, yaw] = [roll, pitch, yaw].map(f64::to_radians);
    mount.rotation *= UnitQuaternion::from_euler_angles(roll, pitch, yaw);
}

/// Plants errors of all radars at once: what is said is the truth plus these.
pub fn plant(p: &mut Planted, errors: &[SensorChange]) {
    for (radar, error) in errors.iter().enumerate() {
        let [roll, pitch, yaw] = error.turn_deg;
        turned(p, radar, roll, pitch, yaw);
        let [x, y, z] = error.shift_m;
        shifted(&mut p.sequence.rig.radars[radar].vehicle_from_radar, x, y, z);
        let late = (error.clock_ms * 1e6) as i64;
        p.sequence.times.radars[radar].iter_mut().for_each(|t| *t += late);
    }
}

pub(super) fn shifted(mount: &mut Transform, x: f64, y: f64, z: f64) {
    mount.translation.vector += nalgebra::Vector3::new(x, y, z);
}

/// A rotation that is told as w, x, y, z.
pub(super) fn w_first(mount: &mut Transform) {
    let q = mount.rotation.coords;
    mount.rotation = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q.z, q.w, q.x, q.y));
}

pub(super) fn lidar_turned(p: &mut Planted, roll: f64, pitch: f64, yaw: f64) {
    let mount = &mut p.sequence.rig.lidars[0].vehicle_from_lidar;
    let [roll, pitch, yaw] = [roll, pitch, yaw].map(f64::to_radians);
    mount.rotation *= UnitQuaternion::from_euler_angles(roll, pitch, yaw);
}

/// Changes where every point of the LiDAR lies, in its own frame.
pub(super) fn lidar_points(p: &mut Planted, place: fn([f32; 3]) -> [f32; 3]) {
    p.edit_lidar(move |scan| scan.points.iter_mut().for_each(|point| *point = place(*point)));
}

pub(super) fn radar_late(p: &mut Planted, radar: usize, ms: i64) {
    p.sequence.times.radars[radar].iter_mut().for_each(|t| *t += ms * MS);
}

/// Spherical fields in place of x, y, z, the angles times a factor.
pub(super) fn spherical(p: &mut Planted, azimuth: f64, elevation: f64) {
    for radar in &mut p.sequence.rig.radars {
        radar.fields = ["range", "azimuth", "elevation", "doppler", "rcs"].map(str::to_owned).into();
    }
    p.edit_radars(move |_, _, columns| {
        for row in 0..columns[0].len() {
            let [x, y, z] = [0, 1, 2].map(|column| f64::from(columns[column][row]));
            let range = x.hypot(y).hypot(z);
            columns[0][row] = range as f32;
            columns[1][row] = (y.atan2(x) * azimuth) as f32;
            columns[2][row] = ((z / range).asin() * elevation) as f32;
        }
    });
}

pub(super) fn times(p: &mut Planted, radar: Option<usize>, columns: &'static [usize], factor: f32) {
    p.edit_radars(move |own, _, values| {
        if radar.is_none_or(|radar| radar == own) {
            columns.iter().for_each(|column| values[*column].iter_mut().for_each(|v| *v *= factor));
        }
    });
}

/// x for y, of one radar or of all.
pub(super) fn exchanged(p: &mut Planted, radar: Option<usize>) {
    p.edit_radars(move |own, _, columns| {
        if radar.is_none_or(|radar| radar == own) {
            columns.swap(0, 1);
        }
    });
}

pub(super) fn swap(p: &mut Planted, a: usize, b: usize) {
    let radars = &mut p.sequence.rig.radars;
    (radars[a].vehicle_from_radar, radars[b].vehicle_from_radar) =
        (radars[b].vehicle_from_radar, radars[a].vehicle_from_radar);
}
