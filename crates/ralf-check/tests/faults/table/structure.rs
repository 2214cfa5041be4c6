//! What was read as something else, or not at all.

use super::planting::times;
use super::{FRONT, Fault, MS};
use crate::recording::Planted;
use ralf::space::{EgoMotion, PoseSample};
use ralf_check::Remedy;

pub(super) fn faults() -> Vec<Fault> {
    [of_scans(), of_order(), of_motion()].into_iter().flatten().collect()
}

/// Of LiDARs and radars.
fn of_scans() -> Vec<Fault> {
    vec![
        fault!("LiDAR rows of 4 read as 5", ["lidar_top"], true, |p| p.edit_lidar(|scan| {
            let intensity = scan.intensity.clone();
            let rows = scan.points.iter().zip(intensity);
            let flat: Vec<f32> = rows.flat_map(|([x, y, z], i)| [*x, *y, *z, i]).collect();
            scan.points = flat.chunks_exact(5).map(|row| [row[0], row[1], row[2]]).collect();
        })),
        fault!("LiDAR rows of 5 read as 4", ["lidar_top"], true, |p| p.edit_lidar(|scan| {
            let rows = scan.points.iter().zip(&scan.intensity).enumerate();
            let flat: Vec<f32> =
                rows.flat_map(|(i, ([x, y, z], v))| [*x, *y, *z, *v, (i % 32) as f32]).collect();
            scan.points = flat.chunks_exact(4).map(|row| [row[0], row[1], row[2]]).collect();
            scan.intensity = flat.chunks_exact(4).map(|row| row[3]).collect();
        })),
        fault!("LiDAR float64 read as float32", ["lidar_top"], true, |p| p.edit_lidar(|scan| {
            let halves = |v: &f32| f64::from(*v).to_le_bytes();
            let bytes: Vec<u8> = scan.points.iter().flatten().flat_map(halves).collect();
            let word = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
            let flat: Vec<f32> = bytes.chunks_exact(4).map(word).collect();
            scan.points = flat.chunks_exact(4).map(|row| [row[0], row[1], row[2]]).collect();
        })),
        fault!(
            "radar float64 read as float32",
            ["radar_front"],
            true,
            |p| p.edit_radars(|radar, _, columns| {
                if radar == FRONT {
                    *columns = as_halves(columns);
                }
            }),
            |r| matches!(r, Remedy::LookInto(what) if what.contains("another type"))
        ),
        fault!("radar x, y, z of range, azimuth, elevation", ["radar_front"], true, |p| p.edit_radars(
            |radar, _, columns| {
                if radar == FRONT {
                    in_spherical(columns);
                }
            }
        )),
        fault!("radar stuck", ["radar_front"], true, |p| p.read_of_radars(|radar, scan| if radar == FRONT {
            0
        } else {
            scan
        })),
        fault!("LiDAR stuck", ["lidar_top"], true, |p| p.read_of_lidar(|_| 0)),
        fault!("nothing is detected", ["radar_rear"], true, |p| p.edit_radars(|radar, _, columns| {
            if radar == 3 {
                columns.iter_mut().for_each(Vec::clear);
            }
        })),
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
    ]
}

/// Files that don't lie in the order of their times.
fn of_order() -> Vec<Fault> {
    let as_text = |r: &Remedy| matches!(r, Remedy::LookInto(what) if what.contains("as text"));
    let backwards = |r: &Remedy| matches!(r, Remedy::LookInto(what) if what.contains("backwards"));
    vec![
        fault!("LiDAR files sorted as text", ["lidar_top"], true, lidar_as_text, as_text),
        fault!(
            "LiDAR files backwards",
            ["lidar_top"],
            true,
            |p| {
                let last = p.sequence.times.lidars[0].len() - 1;
                p.read_of_lidar(move |scan| last - scan);
            },
            backwards
        ),
        fault!(
            "files of one radar sorted as text",
            ["radar_front"],
            true,
            |p| {
                let files = as_text_of(p.sequence.times.radars[FRONT].len());
                p.read_of_radars(move |radar, scan| if radar == FRONT { files[scan] } else { scan });
            },
            as_text
        ),
        fault!(
            "all files sorted as text",
            ["lidar_top"],
            true,
            |p| {
                lidar_as_text(p);
                let files: Vec<Vec<usize>> =
                    p.sequence.times.radars.iter().map(|times| as_text_of(times.len())).collect();
                p.read_of_radars(move |radar, scan| files[radar][scan]);
            },
            as_text
        ),
    ]
}

fn lidar_as_text(p: &mut Planted) {
    let files = as_text_of(p.sequence.times.lidars[0].len());
    p.read_of_lidar(move |scan| files[scan]);
}

/// Numbers from 0 on as a sort of texts has them.
fn as_text_of(count: usize) -> Vec<usize> {
    let mut files: Vec<usize> = (0..count).collect();
    files.sort_by_key(usize::to_string);
    files
}

/// Of odometry and poses.
fn of_motion() -> Vec<Fault> {
    vec![
        fault!("odometry stuck", ["motion"], true, |p| {
            let first = p.sequence.motion.odometry()[0];
            p.edit_odometry(move |s| (s.velocity, s.yaw_rate) = (first.velocity, first.yaw_rate));
        }),
        fault!("one sample of odometry is a bus's largest number", ["motion"], true, |p| p.replace_odometry(
            |samples| {
                let middle = samples.len() / 2;
                samples[middle].velocity = 655.35;
            }
        )),
        fault!("a yaw rate of 3 rad/s for a tenth of a second", ["motion"], true, |p| p.replace_odometry(
            |samples| {
                let middle = samples.len() / 2;
                let until = samples[middle].t_ns + 100 * MS;
                let spell = samples[middle..].iter_mut().take_while(|sample| sample.t_ns < until);
                spell.for_each(|sample| sample.yaw_rate = 3.0);
            }
        )),
        fault!("poses jump, 200 a second", ["motion"], true, |p| {
            p.add_poses();
            p.replace_poses(|poses| *poses = closer(poses));
            p.replace_poses(|poses| {
                let second_half = poses.len() / 2..;
                let moved = poses[second_half].iter_mut();
                moved.for_each(|pose| pose.odom_from_vehicle.translation.vector.x += 10.0);
            });
        }),
        fault!("odometry ends halfway", ["motion"], true, |p| {
            let samples = p.sequence.motion.odometry().to_vec();
            let half = samples.len() / 2;
            p.sequence.motion = EgoMotion::new(samples[..half].to_vec(), vec![]).unwrap();
        }),
        fault!("yaw rate 10 times too large", ["motion"], false, |p| p.edit_odometry(|s| s.yaw_rate *= 10.0)),
    ]
}

/// Ten poses for each: between two of them the vehicle goes on evenly.
fn closer(poses: &[PoseSample]) -> Vec<PoseSample> {
    let between = |pair: &[PoseSample]| {
        let [first, second] = [pair[0], pair[1]];
        let part = move |i: i64| PoseSample {
            t_ns: first.t_ns + (second.t_ns - first.t_ns) * i / 10,
            odom_from_vehicle: first.odom_from_vehicle.lerp_slerp(&second.odom_from_vehicle, i as f64 / 10.0),
        };
        (0..10).map(part)
    };
    poses.windows(2).flat_map(between).chain(poses.last().copied()).collect()
}

/// The numbers of a scan as float64 that are read as float32: twice as many rows.
fn as_halves(columns: &[Vec<f32>]) -> Vec<Vec<f32>> {
    let rows = 0..columns[0].len();
    // A multiple of no power of two, as measured numbers are.
    let words = rows
        .flat_map(|row| columns.iter().flat_map(move |column| halves(f64::from(column[row]) / 3.0 * 3.1)));
    let words: Vec<f32> = words.collect();
    (0..columns.len())
        .map(|column| words.iter().skip(column).step_by(columns.len()).copied().collect())
        .collect()
}

fn halves(value: f64) -> [f32; 2] {
    let [a, b, c, d, e, f, g, h] = value.to_le_bytes();
    [[a, b, c, d], [e, f, g, h]].map(f32::from_le_bytes)
}

/// x, y and z become range, azimuth and elevation, rad.
fn in_spherical(columns: &mut [Vec<f32>]) {
    for row in 0..columns[0].len() {
        let [x, y, z] = [0, 1, 2].map(|column| columns[column][row]);
        let range = x.hypot(y).hypot(z);
        let spherical = [range, y.atan2(x), (z / range).asin()];
        spherical.into_iter().enumerate().for_each(|(column, value)| columns[column][row] = value);
    }
}
