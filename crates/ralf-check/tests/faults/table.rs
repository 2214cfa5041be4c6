//! The faults: what is planted, whose it is, and which remedy is right.

use crate::recording::Planted;
use nalgebra::{Translation3, UnitQuaternion};
use ralf::sensors::Elevation;
use ralf::space::{EgoMotion, Transform};
use ralf_check::{Remedy, SensorChange};

/// A fault.
pub struct Fault {
    pub name: &'static str,
    pub plant: fn(&mut Planted),
    /// Whose it is: one of these is named in the verdict that notices it.
    pub subjects: &'static [&'static str],
    /// Whether a remedy is the right one; none is asked for where none exists.
    pub remedy: Option<fn(&Remedy) -> bool>,
    /// Whether it can be seen on a straight road, too.
    pub straight: bool,
}

const FRONT: usize = 0;
const LEFT: usize = 1;
const MS: i64 = 1_000_000;

fn turned(p: &mut Planted, radar: usize, roll: f64, pitch: f64, yaw: f64) {
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
        radar_late(p, radar, error.clock_ms as i64);
    }
}

fn shifted(mount: &mut Transform, x: f64, y: f64, z: f64) {
    mount.translation.vector += nalgebra::Vector3::new(x, y, z);
}

fn lidar_turned(p: &mut Planted, roll: f64, pitch: f64, yaw: f64) {
    let mount = &mut p.sequence.rig.lidars[0].vehicle_from_lidar;
    let [roll, pitch, yaw] = [roll, pitch, yaw].map(f64::to_radians);
    mount.rotation *= UnitQuaternion::from_euler_angles(roll, pitch, yaw);
}

fn radar_late(p: &mut Planted, radar: usize, ms: i64) {
    p.sequence.times.radars[radar].iter_mut().for_each(|t| *t += ms * MS);
}

/// Spherical fields in place of x, y, z, the angles times a factor.
fn spherical(p: &mut Planted, azimuth: f64, elevation: f64) {
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

fn times(p: &mut Planted, radar: Option<usize>, columns: &'static [usize], factor: f32) {
    p.edit_radars(move |own, _, values| {
        if radar.is_none_or(|radar| radar == own) {
            columns.iter().for_each(|column| values[*column].iter_mut().for_each(|v| *v *= factor));
        }
    });
}

fn near(value: f64, expected: f64, within: f64) -> bool {
    (value - expected).abs() <= within
}

fn yaw_of(remedy: &Remedy) -> Option<f64> {
    match remedy {
        Remedy::Sensor(change) => Some(change.turn_deg[2]),
        _ => None,
    }
}

fn clock_of(remedy: &Remedy) -> Option<f64> {
    match remedy {
        Remedy::Sensor(change) => Some(change.clock_ms),
        _ => None,
    }
}

macro_rules! fault {
    ($name:literal, $subjects:expr, $straight:literal, $plant:expr) => {
        Fault { name: $name, plant: $plant, subjects: &$subjects, remedy: None, straight: $straight }
    };
    ($name:literal, $subjects:expr, $straight:literal, $plant:expr, $remedy:expr) => {
        Fault { name: $name, plant: $plant, subjects: &$subjects, remedy: Some($remedy), straight: $straight }
    };
}

const ALL_RADARS: [&str; 4] = ["radar_front", "radar_left", "radar_right", "radar_rear"];

/// All of them, numbered from 1 in this order.
pub fn faults() -> Vec<Fault> {
    [extrinsics(), cameras(), clocks(), units(), signs(), structure()].into_iter().flatten().collect()
}

fn extrinsics() -> Vec<Fault> {
    vec![
        fault!("radar yaw +5 deg", ["radar_front"], true, |p| turned(p, FRONT, 0.0, 0.0, 5.0), |r| {
            yaw_of(r).is_some_and(|yaw| near(yaw, -5.0, 1.0))
        }),
        fault!("side radar yaw -3 deg", ["radar_left"], true, |p| turned(p, LEFT, 0.0, 0.0, -3.0), |r| {
            yaw_of(r).is_some_and(|yaw| near(yaw, 3.0, 1.0))
        }),
        fault!("radar yaw 180 deg", ["radar_front"], true, |p| turned(p, FRONT, 0.0, 0.0, 180.0), |r| {
            yaw_of(r).is_some_and(|yaw| near(yaw.abs(), 180.0, 2.0))
        }),
        fault!("radar pitch +5 deg", ["radar_front"], true, |p| turned(p, FRONT, 0.0, 5.0, 0.0), |r| {
            matches!(r, Remedy::Sensor(c) if near(c.turn_deg[1], -5.0, 1.6))
        }),
        fault!("radar roll +6 deg", ["radar_front"], true, |p| turned(p, FRONT, 6.0, 0.0, 0.0), |r| {
            matches!(r, Remedy::Sensor(c) if near(c.turn_deg[0], -6.0, 2.1))
        }),
        fault!(
            "radar 1 m off",
            ["radar_left"],
            true,
            |p| {
                shifted(&mut p.sequence.rig.radars[LEFT].vehicle_from_radar, 0.0, 1.0, 0.0);
            },
            |r| matches!(r, Remedy::Sensor(c) if near(c.shift_m[1], -1.0, 0.35))
        ),
        fault!(
            "radar translation in cm",
            ["radar_front"],
            true,
            |p| {
                p.sequence.rig.radars[FRONT].vehicle_from_radar.translation.vector *= 100.0;
            },
            |r| matches!(r, Remedy::LookInto(what) if what.contains("cm"))
        ),
        fault!("left and right radar swapped", ["radar_left", "radar_right"], true, |p| swap(p, 1, 2), |r| {
            matches!(r, Remedy::SwapWith(other) if other == "radar_left" || other == "radar_right")
        }),
        fault!("front and rear radar swapped", ["radar_front", "radar_rear"], true, |p| swap(p, 0, 3), |r| {
            matches!(r, Remedy::SwapWith(other) if other == "radar_front" || other == "radar_rear")
        }),
        fault!("y mirrored, one radar", ["radar_front"], true, |p| times(p, Some(FRONT), &[1], -1.0), |r| {
            matches!(r, Remedy::Sensor(c) if c.mirrored)
        }),
        fault!("y mirrored, all radars", ALL_RADARS, true, |p| times(p, None, &[1], -1.0), |r| {
            matches!(r, Remedy::Sensor(c) if c.mirrored)
        }),
        fault!("LiDAR yaw +5 deg", ["lidar_top"], true, |p| lidar_turned(p, 0.0, 0.0, 5.0), |r| {
            yaw_of(r).is_some_and(|yaw| near(yaw, -5.0, 1.0))
        }),
        fault!(
            "LiDAR axes x right, y forward",
            ["lidar_top"],
            true,
            |p| lidar_turned(p, 0.0, 0.0, -90.0),
            |r| { yaw_of(r).is_some_and(|yaw| near(yaw, 90.0, 3.0)) }
        ),
        fault!("LiDAR pitch +4 deg", ["lidar_top"], true, |p| lidar_turned(p, 0.0, 4.0, 0.0), |r| {
            matches!(r, Remedy::Sensor(c) if near(c.turn_deg[1], -4.0, 0.8))
        }),
        fault!(
            "LiDAR 0.5 m too high",
            ["lidar_top"],
            true,
            |p| {
                shifted(&mut p.sequence.rig.lidars[0].vehicle_from_lidar, 0.0, 0.0, 0.5);
            },
            |r| matches!(r, Remedy::Sensor(c) if near(c.shift_m[2], -0.5, 0.1))
        ),
        fault!("quaternion read as w x y z", ["radar_left"], true, |p| {
            // (0, 0, s, c) taken for w, x, y, z.
            let mount = &mut p.sequence.rig.radars[LEFT].vehicle_from_radar;
            let q = mount.rotation.coords;
            mount.rotation = UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q.x, q.y, q.z, q.w));
            mount.translation = Translation3::from(mount.translation.vector);
        }),
    ]
}

fn cameras() -> Vec<Fault> {
    vec![
        fault!(
            "camera yaw +3 deg",
            ["camera_front"],
            true,
            |p| {
                // To the left about the vehicle's vertical: the right remedy turns it to the right about the optical y.
                let mount = &mut p.sequence.rig.cameras[FRONT].vehicle_from_camera;
                mount.rotation =
                    UnitQuaternion::from_euler_angles(0.0, 0.0, 3.0_f64.to_radians()) * mount.rotation;
            },
            |r| matches!(r, Remedy::Camera(c) if near(c.turn_deg[1], 3.0, 1.0))
        ),
        fault!(
            "camera clock +200 ms",
            ["camera_front"],
            false,
            |p| p.sequence.times.cameras[FRONT].iter_mut().for_each(|t| *t += 200 * MS),
            |r| matches!(r, Remedy::Camera(c) if near(c.clock_ms, -200.0, 60.0))
        ),
        fault!(
            "left and right camera swapped",
            ["camera_left", "camera_right"],
            true,
            |p| {
                let cameras = &mut p.sequence.rig.cameras;
                (cameras[1].vehicle_from_camera, cameras[2].vehicle_from_camera) =
                    (cameras[2].vehicle_from_camera, cameras[1].vehicle_from_camera);
            },
            |r| matches!(r, Remedy::SwapWith(other) if other.starts_with("camera_"))
        ),
    ]
}

fn swap(p: &mut Planted, a: usize, b: usize) {
    let radars = &mut p.sequence.rig.radars;
    (radars[a].vehicle_from_radar, radars[b].vehicle_from_radar) =
        (radars[b].vehicle_from_radar, radars[a].vehicle_from_radar);
}

fn clocks() -> Vec<Fault> {
    vec![
        fault!("radar clock +200 ms", ["radar_left"], true, |p| radar_late(p, LEFT, 200), |r| {
            clock_of(r).is_some_and(|ms| near(ms, -200.0, 60.0))
        }),
        fault!("radar clock -200 ms", ["radar_front"], true, |p| radar_late(p, FRONT, -200), |r| {
            clock_of(r).is_some_and(|ms| near(ms, 200.0, 60.0))
        }),
        fault!(
            "all radar clocks +200 ms",
            ALL_RADARS,
            true,
            |p| (0..4).for_each(|radar| radar_late(p, radar, 200)),
            |r| { clock_of(r).is_some_and(|ms| near(ms, -200.0, 60.0)) }
        ),
        fault!(
            "LiDAR clock +200 ms",
            ["lidar_top"],
            true,
            |p| {
                p.sequence.times.lidars[0].iter_mut().for_each(|t| *t += 200 * MS);
            },
            |r| clock_of(r).is_some_and(|ms| near(ms, -200.0, 60.0))
        ),
        fault!(
            "odometry clock +200 ms",
            ["motion"],
            true,
            |p| p.edit_odometry(|s| s.t_ns += 200 * MS),
            |r| { matches!(r, Remedy::MotionClock(ms) if near(*ms, -200.0, 60.0)) }
        ),
        fault!("timestamps in us, taken for ns", ["radar_front"], true, |p| {
            p.sequence.times.radars[FRONT].iter_mut().for_each(|t| *t /= 1000);
        }),
    ]
}

fn units() -> Vec<Fault> {
    vec![
        fault!("positions in cm", ["radar_front"], true, |p| times(p, Some(FRONT), &[0, 1, 2], 100.0), |r| {
            matches!(r, Remedy::Positions(f) if near(*f, 0.01, 1e-9))
        }),
        fault!(
            "LiDAR in cm",
            ["lidar_top"],
            true,
            |p| p.edit_lidar(|scan| {
                scan.points.iter_mut().flatten().for_each(|v| *v *= 100.0);
            }),
            |r| matches!(r, Remedy::Positions(f) if near(*f, 0.01, 1e-9))
        ),
        fault!("Doppler in km/h, one radar", ["radar_rear"], true, |p| times(p, Some(3), &[3], 3.6), |r| {
            matches!(r, Remedy::Doppler(f) if near(*f, 1.0 / 3.6, 0.02))
        }),
        fault!("Doppler in km/h, all radars", ALL_RADARS, true, |p| times(p, None, &[3], 3.6), |r| {
            matches!(r, Remedy::Doppler(f) if near(*f, 1.0 / 3.6, 0.02))
        }),
        fault!("speed in km/h", ["motion"], true, |p| p.edit_odometry(|s| s.velocity *= 3.6), |r| {
            matches!(r, Remedy::Speed(f) if near(*f, 1.0 / 3.6, 0.02))
        }),
        fault!("speed in cm/s", ["motion"], true, |p| p.edit_odometry(|s| s.velocity *= 100.0), |r| {
            matches!(r, Remedy::Speed(f) if near(*f, 0.01, 1e-6))
        }),
        fault!(
            "yaw rate in deg/s",
            ["motion"],
            false,
            |p| p.edit_odometry(|s| s.yaw_rate = s.yaw_rate.to_degrees()),
            |r| { matches!(r, Remedy::YawRate(f) if near(*f, 1.0_f64.to_radians(), 1e-6)) }
        ),
        fault!("azimuth in degrees", ["radar_front"], true, |p| spherical(p, 57.2958, 1.0), |r| {
            matches!(r, Remedy::InDegrees("azimuth"))
        }),
        fault!("elevation in degrees", ["radar_front"], true, |p| spherical(p, 1.0, 57.2958), |r| {
            matches!(r, Remedy::InDegrees("elevation"))
        }),
        fault!(
            "field of view in radians",
            ["radar_front"],
            true,
            |p| {
                let radar = &mut p.sequence.rig.radars[FRONT];
                radar.fov_azimuth = radar.fov_azimuth.to_radians();
            },
            |r| matches!(r, Remedy::Value { key: "fov_azimuth_deg", value } if *value > 100.0)
        ),
        fault!(
            "sigma in radians",
            ["radar_front"],
            true,
            |p| {
                let radar = &mut p.sequence.rig.radars[FRONT];
                radar.sigma_azimuth = radar.sigma_azimuth.to_radians();
            },
            |r| matches!(r, Remedy::Value { key: "sigma_azimuth_deg", value } if near(*value, 0.6, 0.05))
        ),
        fault!(
            "sigma of range in cm",
            ["radar_front"],
            true,
            |p| p.sequence.rig.radars[FRONT].sigma_range *= 100.0,
            |r| { matches!(r, Remedy::Value { key: "sigma_range_m", value } if near(*value, 0.1, 0.01)) }
        ),
    ]
}

fn signs() -> Vec<Fault> {
    vec![
        fault!("Doppler sign, one radar", ["radar_left"], true, |p| times(p, Some(LEFT), &[3], -1.0), |r| {
            matches!(r, Remedy::Doppler(f) if *f == -1.0)
        }),
        fault!("Doppler sign, all radars", ALL_RADARS, true, |p| times(p, None, &[3], -1.0), |r| {
            matches!(r, Remedy::Doppler(f) if *f == -1.0)
        }),
        fault!("speed sign", ["motion"], true, |p| p.edit_odometry(|s| s.velocity = -s.velocity), |r| {
            matches!(r, Remedy::Speed(f) if *f == -1.0)
        }),
        fault!("yaw rate sign", ["motion"], false, |p| p.edit_odometry(|s| s.yaw_rate = -s.yaw_rate), |r| {
            matches!(r, Remedy::YawRate(f) if *f == -1.0)
        }),
        fault!("Doppler already compensated", ["radar_front"], true, |p| times(p, Some(FRONT), &[3], 0.02)),
    ]
}

fn structure() -> Vec<Fault> {
    vec![
        fault!("LiDAR rows of 4 read as 5", ["lidar_top"], true, |p| p.edit_lidar(|scan| {
            let intensity = scan.intensity.clone();
            let rows = scan.points.iter().zip(intensity);
            let flat: Vec<f32> = rows.flat_map(|([x, y, z], i)| [*x, *y, *z, i]).collect();
            scan.points = flat.chunks_exact(5).map(|row| [row[0], row[1], row[2]]).collect();
        })),
        fault!("LiDAR float64 read as float32", ["lidar_top"], true, |p| p.edit_lidar(|scan| {
            let halves = |v: &f32| f64::from(*v).to_le_bytes();
            let bytes: Vec<u8> = scan.points.iter().flatten().flat_map(halves).collect();
            let word = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
            let flat: Vec<f32> = bytes.chunks_exact(4).map(word).collect();
            scan.points = flat.chunks_exact(4).map(|row| [row[0], row[1], row[2]]).collect();
        })),
        fault!("radar stuck", ["radar_front"], true, |p| p.stuck_radar = Some(FRONT)),
        fault!("LiDAR stuck", ["lidar_top"], true, |p| p.stuck_lidar = true),
        fault!("odometry stuck", ["motion"], true, |p| {
            let first = p.sequence.motion.odometry()[0];
            p.edit_odometry(move |s| (s.velocity, s.yaw_rate) = (first.velocity, first.yaw_rate));
        }),
        fault!("odometry ends halfway", ["motion"], true, |p| {
            let samples = p.sequence.motion.odometry().to_vec();
            let half = samples.len() / 2;
            p.sequence.motion = EgoMotion::new(samples[..half].to_vec(), vec![]).unwrap();
        }),
        fault!("elevation constant, said to be measured", ["radar_front"], true, |p| times(
            p,
            Some(FRONT),
            &[2],
            0.0
        )),
        fault!("a third of the detections not finite", ["radar_front"], true, |p| p.edit_radars(
            |radar, _, columns| {
                if radar == FRONT {
                    columns[0].iter_mut().step_by(3).for_each(|v| *v = f32::NAN);
                }
            }
        )),
        fault!("yaw rate 10 times too large", ["motion"], false, |p| p.edit_odometry(|s| s.yaw_rate *= 10.0)),
    ]
}

/// Whether radars of the simulator measure elevation: faults of elevation rely on it.
pub fn measures_elevation(p: &Planted) -> bool {
    p.sequence.rig.radars.iter().all(|radar| radar.elevation == Elevation::Measured)
}
