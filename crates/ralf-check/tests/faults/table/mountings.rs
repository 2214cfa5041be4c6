//! Mountings of radars, LiDARs and cameras.

use super::planting::{exchanged, lidar_points, lidar_turned, shifted, swap, times, turned, w_first};
use super::right::{near, yaw_of};
use super::{ALL_RADARS, FRONT, Fault, LEFT, MS};
use nalgebra::UnitQuaternion;
use ralf_check::Remedy;

pub(super) fn radars() -> Vec<Fault> {
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
        fault!("x and y exchanged, one radar", ["radar_front"], true, |p| exchanged(p, Some(FRONT)), |r| {
            *r == Remedy::Exchanged
        }),
        fault!("x and y exchanged, side radar", ["radar_left"], true, |p| exchanged(p, Some(LEFT)), |r| {
            *r == Remedy::Exchanged
        }),
        fault!("x and y exchanged, all radars", ALL_RADARS, true, |p| exchanged(p, None), |r| {
            *r == Remedy::Exchanged
        }),
        fault!(
            "quaternion read as w x y z",
            ["radar_left"],
            true,
            |p| {
                // (0, 0, s, c) taken for w, x, y, z.
                let mount = &mut p.sequence.rig.radars[LEFT].vehicle_from_radar;
                let q = mount.rotation.coords;
                mount.rotation =
                    UnitQuaternion::from_quaternion(nalgebra::Quaternion::new(q.x, q.y, q.z, q.w));
            },
            is_other_order
        ),
        fault!(
            "quaternions told as w x y z",
            ["radar_left"],
            true,
            |p| {
                p.sequence.rig.radars.iter_mut().for_each(|radar| w_first(&mut radar.vehicle_from_radar));
                p.sequence.rig.lidars.iter_mut().for_each(|lidar| w_first(&mut lidar.vehicle_from_lidar));
            },
            is_other_order
        ),
        fault!(
            "radar below the road",
            ["radar_front"],
            true,
            |p| {
                p.sequence.rig.radars[FRONT].vehicle_from_radar.translation.z *= -1.0;
            },
            |r| matches!(r, Remedy::LookInto(what) if what.contains("z down"))
        ),
        fault!(
            "radar mounting the other way round",
            ["radar_left"],
            true,
            |p| {
                let mount = &mut p.sequence.rig.radars[LEFT].vehicle_from_radar;
                *mount = mount.inverse();
            },
            |r| matches!(r, Remedy::LookInto(what) if what.contains("other way round") || what.contains("z down"))
        ),
    ]
}

fn is_other_order(remedy: &Remedy) -> bool {
    matches!(remedy, Remedy::LookInto(what) if what.contains("w, x, y, z"))
}

pub(super) fn lidars() -> Vec<Fault> {
    vec![
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
        fault!("LiDAR yaw +60 deg", ["lidar_top"], true, |p| lidar_turned(p, 0.0, 0.0, 60.0), |r| {
            yaw_of(r).is_some_and(|yaw| near(yaw, -60.0, 2.0))
        }),
        fault!("LiDAR y mirrored", ["lidar_top"], true, |p| lidar_points(p, |[x, y, z]| [x, -y, z]), |r| {
            matches!(r, Remedy::Sensor(c) if c.mirrored)
        }),
        fault!("LiDAR x and y exchanged", ["lidar_top"], true, |p| lidar_points(p, |[x, y, z]| [y, x, z])),
        fault!("LiDAR points in another frame", ["lidar_top"], true, |p| {
            lidar_points(p, |[x, y, z]| [x + 60.0, y + 80.0, z]);
        }),
        fault!("LiDAR points in the vehicle's frame", ["lidar_top"], true, |p| {
            let t = p.sequence.rig.lidars[0].vehicle_from_lidar.translation.vector;
            let [x, y, z] = [t.x, t.y, t.z].map(|v| v as f32);
            p.edit_lidar(move |scan| {
                scan.points.iter_mut().for_each(|p| *p = [p[0] + x, p[1] + y, p[2] + z])
            });
        }),
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
        fault!(
            "LiDAR lowest beam in radians",
            ["lidar_top"],
            true,
            |p| {
                let lowest = &mut p.sequence.rig.lidars[0].lowest_beam;
                *lowest = lowest.to_radians();
            },
            |r| matches!(r, Remedy::Value { key: "lowest_beam_deg", value } if near(*value, 16.0, 1.0))
        ),
    ]
}

pub(super) fn cameras() -> Vec<Fault> {
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
        fault!(
            "camera mounting the other way round",
            ["camera_front"],
            true,
            |p| {
                let mount = &mut p.sequence.rig.cameras[FRONT].vehicle_from_camera;
                *mount = mount.inverse();
            },
            |r| matches!(r, Remedy::LookInto(what) if what.contains("other way round"))
        ),
        fault!(
            "camera in the axes of other sensors",
            ["camera_front"],
            true,
            |p| {
                p.sequence.rig.cameras[FRONT].vehicle_from_camera.rotation = UnitQuaternion::identity();
            },
            |r| matches!(r, Remedy::LookInto(what) if what.contains("z ahead"))
        ),
    ]
}
