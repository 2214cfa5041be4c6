//! Units of what is measured, of the motion and of the rig.

use super::planting::{spherical, times};
use super::right::near;
use super::{ALL_RADARS, FRONT, Fault};
use crate::recording::Planted;
use ralf::sensors::Intrinsics;
use ralf_check::Remedy;

pub(super) fn faults() -> Vec<Fault> {
    [of_lengths(), of_speeds(), of_angles()].into_iter().flatten().collect()
}

/// What is measured in metres.
fn of_lengths() -> Vec<Fault> {
    vec![
        fault!("positions in cm", ["radar_front"], true, |p| times(p, Some(FRONT), &[0, 1, 2], 100.0), |r| {
            matches!(r, Remedy::Positions(f) if near(*f, 0.01, 1e-9))
        }),
        fault!(
            "ranges there and back",
            ["radar_front"],
            true,
            |p| times(p, Some(FRONT), &[0, 1, 2], 2.0),
            |r| { matches!(r, Remedy::Positions(f) if near(*f, 0.5, 1e-9)) }
        ),
        fault!("positions in feet", ALL_RADARS, true, |p| times(p, None, &[0, 1, 2], 1.0 / 0.3048), |r| {
            matches!(r, Remedy::Positions(f) if near(*f, 0.3048, 1e-9))
        }),
        fault!(
            "elevation has the other sign",
            ["radar_front"],
            true,
            |p| times(p, Some(FRONT), &[2], -1.0),
            |r| { matches!(r, Remedy::LookInto(what) if what.contains("other sign")) }
        ),
        fault!("elevation is noise", ["radar_front"], true, noise_for_elevation, |r| {
            matches!(r, Remedy::LookInto(what) if what.contains("another field"))
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
        fault!(
            "sigma of range in cm",
            ["radar_front"],
            true,
            |p| p.sequence.rig.radars[FRONT].sigma_range *= 100.0,
            |r| { matches!(r, Remedy::Value { key: "sigma_range_m", value } if near(*value, 0.1, 0.01)) }
        ),
        fault!(
            "LiDAR's sigma in mm",
            ["lidar_top"],
            true,
            |p| p.sequence.rig.lidars[0].sigma_range *= 1000.0,
            |r| matches!(r, Remedy::Value { key: "sigma_range_m", value } if *value < 0.5)
        ),
        fault!(
            "lens of images twice as large",
            ["camera_front"],
            true,
            |p| {
                let camera = &mut p.sequence.rig.cameras[FRONT];
                match &mut camera.intrinsics {
                    Intrinsics::Pinhole { focal, center, .. }
                    | Intrinsics::KannalaBrandt { focal, center, .. } => {
                        focal.iter_mut().chain(center).for_each(|pixels| *pixels *= 2.0);
                    }
                    Intrinsics::Scaramuzza { inverse_polynomial, center, .. } => {
                        inverse_polynomial.iter_mut().chain(center).for_each(|pixels| *pixels *= 2.0);
                    }
                }
            },
            |r| matches!(r, Remedy::LookInto(what) if what.contains("larger"))
        ),
    ]
}

/// Speeds, and what turns.
fn of_speeds() -> Vec<Fault> {
    vec![
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
    ]
}

/// Angles of detections and of the rig.
fn of_angles() -> Vec<Fault> {
    vec![
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
    ]
}

/// Elevations of another field, spread over 0.3 rad to either side.
fn noise_for_elevation(p: &mut Planted) {
    p.edit_radars(|radar, scan, columns| {
        let [x, y, z, ..] = &mut columns[..] else { return };
        for (row, ((x, y), z)) in x.iter().zip(y.iter()).zip(z).enumerate().filter(|_| radar == FRONT) {
            // Golden steps lie evenly, and not as their neighbours do.
            let part = ((scan * 7919 + row) as f64 * 0.618_033_988_75).fract();
            *z = x.hypot(*y) * ((part as f32 - 0.5) * 0.6).tan();
        }
    });
}
