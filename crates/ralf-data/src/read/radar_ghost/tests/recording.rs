//! Sequences in the Radar Ghost Dataset's layout: a standing vehicle before a wall on the left, in which a walking
//! person is mirrored.

use super::hdf5::{Columns, Values, write_tables};
use std::f64::consts::FRAC_PI_6;
use std::path::Path;

/// Frames of a sequence, of 60 ms.
pub(crate) const FRAMES: usize = 5;
/// The right radar measures this much later than the left one, s.
pub(crate) const LATER: f64 = 0.004;
/// Where the radars and the LiDAR are: x, y, z, m, and yaw, rad.
const LEFT: [f64; 4] = [3.739, 0.658, 0.0305, FRAC_PI_6];
const RIGHT: [f64; 4] = [3.739, -0.658, 0.0305, -FRAC_PI_6];
/// Where the wall is, m to the left.
const WALL: f64 = 6.0;

/// The name of a sequence's file.
pub(crate) const FILE: &str = "original/test/scenario-01_sequence-01_ped_test.h5";

/// A detection: its place in the car's frame, its range rate as if it moved with (vx, vy), and its label.
struct Seen {
    place: [f64; 2],
    velocity: [f64; 2],
    label_id: i64,
    instance: i32,
    group: bool,
}

/// What a radar sees in a frame: the person, its image in the wall, an image nobody is sure of, the wall, and noise.
fn seen(frame: usize) -> Vec<Seen> {
    let person = [14.0 - 0.09 * frame as f64, 2.0];
    let image = [person[0], 2.0 * WALL - person[1]];
    let seen =
        |place, velocity, label_id, instance| Seen { place, velocity, label_id, instance, group: false };
    let towards = [-1.5, 0.0];
    vec![
        seen(person, towards, 1111, 1),
        seen([person[0] + 0.1, person[1] + 0.05], towards, 1111, 1),
        seen(image, towards, 1122, 2),
        seen([image[0] + 0.2, image[1]], towards, -1112, 2),
        seen([10.0, WALL], [0.0, 0.0], 0, -1),
        seen([16.0, WALL], [0.0, 0.0], 0, -1),
        seen([25.0, -7.5], [3.0, 0.0], -2, -1),
        Seen { group: true, ..seen([30.0, 1.0], towards, 1011, 3) },
    ]
}

/// The radar's table, a row per detection and radar.
pub(crate) fn radar() -> Columns {
    let mut rows = Vec::new();
    for frame in 0..FRAMES {
        for (sensor, mounting, after) in [("left", LEFT, 0.0), ("right", RIGHT, LATER)] {
            rows.extend(seen(frame).into_iter().map(|seen| (frame, sensor, mounting, after, seen)));
        }
    }
    let sc = |mounting: &[f64; 4], seen: &Seen| {
        let [x, y] = [seen.place[0] - mounting[0], seen.place[1] - mounting[1]];
        let range = x.hypot(y);
        let along = (x * seen.velocity[0] + y * seen.velocity[1]) / range;
        [range, y.atan2(x) - mounting[3], along]
    };
    let double = |value: &dyn Fn(&[f64; 4], &Seen) -> f64| {
        Values::Double(rows.iter().map(|(_, _, mounting, _, seen)| value(mounting, seen)).collect())
    };
    let text =
        |bytes, value: &dyn Fn(usize) -> String| Values::Text(bytes, (0..rows.len()).map(value).collect());
    vec![
        ("frame", Values::Long(rows.iter().map(|row| row.0 as i64).collect())),
        ("frame_timestamp", Values::Double(rows.iter().map(|row| 0.06 * row.0 as f64).collect())),
        ("timestamp", Values::Double(rows.iter().map(|row| 0.06 * row.0 as f64 + row.3).collect())),
        ("sensor", text(5, &|row| rows[row].1.to_owned())),
        ("x_cc", double(&|_, seen| seen.place[0])),
        ("y_cc", double(&|_, seen| seen.place[1])),
        ("r_sc", double(&|mounting, seen| sc(mounting, seen)[0])),
        ("phi_sc", double(&|mounting, seen| sc(mounting, seen)[1])),
        ("vr_sc", double(&|mounting, seen| sc(mounting, seen)[2])),
        ("amp", Values::Float(vec![61.5; rows.len()])),
        ("uuid", text(32, &|row| format!("{row:032x}"))),
        ("label_id", Values::Long(rows.iter().map(|row| row.4.label_id).collect())),
        ("instance_id", Values::Int(rows.iter().map(|row| row.4.instance).collect())),
        ("human_readable_label", text(16, &|_| "whatever".to_owned())),
        ("group", Values::Byte(rows.iter().map(|row| u8::from(row.4.group)).collect())),
        ("mirror", text(8, &|_| "wall".to_owned())),
    ]
}

/// The LiDAR's table: the wall, the person and the road, every 100 ms.
pub(crate) fn lidar() -> Columns {
    let mut rows: Vec<(f64, [f64; 3])> = Vec::new();
    for scan in 0..4 {
        let t = 0.1 * f64::from(scan) - 0.02;
        let person = [14.0 - 1.5 * t, 2.0];
        let wall =
            (0..60).flat_map(|x| (0..8).map(move |z| [4.0 + 0.4 * f64::from(x), WALL, 0.3 * f64::from(z)]));
        let road = (0..40).flat_map(|x| (-5..6).map(move |y| [5.0 + 0.5 * f64::from(x), f64::from(y), -0.4]));
        let someone = (0..10).map(|z| [person[0], person[1], -0.3 + 0.2 * f64::from(z)]);
        rows.extend(wall.chain(road).chain(someone).map(|place| (t, place)));
    }
    let column = |axis: usize| Values::Float(rows.iter().map(|row| row.1[axis] as f32).collect());
    let places = rows.len();
    vec![
        ("timestamp", Values::Double(rows.iter().map(|row| row.0).collect())),
        ("x_cc", column(0)),
        ("y_cc", column(1)),
        ("z_cc", column(2)),
        ("r_sc", Values::Float(vec![0.0; places])),
        ("theta_sc", Values::Float(vec![0.0; places])),
        ("phi_sc", Values::Float(vec![0.0; places])),
        ("uuid", Values::Text(32, (0..places).map(|row| format!("{row:032x}")).collect())),
    ]
}

/// Writes a sequence's file.
pub(crate) fn write_sequence(file: &Path, radar: &Columns, lidar: &Columns) {
    write_tables(file, &[("radar", radar), ("lidar", lidar)], 64);
}

/// Writes a dataset of one sequence.
pub(crate) fn write_dataset(folder: &Path) {
    write_sequence(&folder.join(FILE), &radar(), &lidar());
}
