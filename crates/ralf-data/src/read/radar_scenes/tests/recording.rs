//! A sequence in RadarScenes' layout: a car that drives past posts, and one that it follows.

use super::hdf5::{Columns, Values, write_tables};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

/// Time of the first scan, us.
pub(crate) const T0: i64 = 156_862_647_501;
/// Scans of each radar, of 60 ms.
pub(crate) const SCANS: usize = 4;
/// The vehicle drives straight ahead, m/s, from a place far from the origin, m.
pub(crate) const SPEED: f64 = 8.0;
const BEGIN: [f64; 2] = [512.0, -64.0];
/// Radars 2 and 3: where they are, m, and where they look, rad.
const RADARS: [(i32, [f64; 3]); 2] = [(2, [3.86, -0.7, -0.436185662]), (3, [3.86, 0.7, 0.436])];
/// In the sequence's frame, m.
const POSTS: [[f64; 2]; 3] = [[540.0, -60.0], [552.0, -68.0], [560.0, -64.5]];

/// The tables of detections and odometry, and the scenes.
pub(crate) struct Sequence {
    pub(crate) radar: Columns,
    pub(crate) odometry: Columns,
    pub(crate) scenes: Value,
}

/// A detection: radar, time, place in the sequence's frame, its speed ahead, label and track.
type Row = (i32, i64, [f64; 2], f64, i64, &'static str);

/// The sequence, with labels of its authors or of clutter-ds.
pub(crate) fn sequence(clutter_ds: bool) -> Sequence {
    let [standing, car, ghost] = if clutter_ds { [2, 1, 0] } else { [11, 0, 11] };
    let (mut rows, mut scenes): (Vec<Row>, _) = (Vec::new(), serde_json::Map::new());
    for scan in 0..SCANS {
        for (n, (id, _)) in RADARS.iter().enumerate() {
            let t_us = T0 + 60_000 * scan as i64 + 12_250 * n as i64;
            let first = rows.len();
            let driven = SPEED * (t_us - T0) as f64 * 1e-6;
            rows.extend(POSTS.map(|post| (*id, t_us, post, 0.0, standing, "")));
            rows.push((*id, t_us, [530.0 + driven, -64.0], SPEED, car, "a3f0"));
            // What a mirror shows, and nothing at all.
            rows.push((*id, t_us, [531.0 + driven, -56.0], SPEED, ghost, ""));
            // A scan in which the second radar sees nothing.
            if (scan, n) == (2, 1) {
                rows.truncate(first);
            }
            let about = json!({"sensor_id": id, "radar_indices": [first, rows.len()], "odometry_index": scan,
                               "odometry_timestamp": t_us, "image_name": "1.jpg", "next_timestamp": null});
            scenes.insert(t_us.to_string(), about);
        }
    }
    let scenes =
        json!({"sequence_name": "sequence_1", "category": "train", "first_timestamp": T0, "scenes": scenes});
    Sequence { radar: detections(&rows), odometry: odometry(), scenes }
}

fn detections(rows: &[Row]) -> Columns {
    let single =
        |value: &dyn Fn(&Row) -> f64| Values::Float(rows.iter().map(|row| value(row) as f32).collect());
    let in_car = |(_, t_us, place, ..): &Row| {
        let driven = SPEED * (t_us - T0) as f64 * 1e-6;
        [place[0] - BEGIN[0] - driven, place[1] - BEGIN[1]]
    };
    let in_radar = |row: &Row| {
        let at = RADARS.iter().find(|(id, _)| *id == row.0).unwrap().1;
        let [x, y] = in_car(row);
        let [x, y] = [x - at[0], y - at[1]];
        [x.hypot(y), y.atan2(x) - at[2], x / x.hypot(y)]
    };
    vec![
        ("timestamp", Values::Long(rows.iter().map(|row| row.1).collect())),
        ("sensor_id", Values::Byte(rows.iter().map(|row| row.0 as u8).collect())),
        ("range_sc", single(&|row| in_radar(row)[0])),
        ("azimuth_sc", single(&|row| in_radar(row)[1])),
        ("rcs", single(&|_| -3.5)),
        ("vr", single(&|row| (row.3 - SPEED) * in_radar(row)[2])),
        ("vr_compensated", single(&|row| row.3 * in_radar(row)[2])),
        ("x_cc", single(&|row| in_car(row)[0])),
        ("y_cc", single(&|row| in_car(row)[1])),
        ("x_seq", single(&|row| row.2[0])),
        ("y_seq", single(&|row| row.2[1])),
        ("uuid", Values::Text(32, (0..rows.len()).map(|row| format!("{row:032x}")).collect())),
        ("track_id", Values::Text(32, rows.iter().map(|row| row.5.to_owned()).collect())),
        ("label_id", Values::Byte(rows.iter().map(|row| row.4 as u8).collect())),
    ]
}

/// Every 10 ms, from before the first scan until after the last.
fn odometry() -> Columns {
    let times: Vec<i64> = (-3..30).map(|n| T0 + 10_000 * n).collect();
    let rows = times.len();
    let x = times.iter().map(|t| BEGIN[0] + SPEED * (t - T0) as f64 * 1e-6).collect();
    vec![
        ("timestamp", Values::Long(times)),
        ("x_seq", Values::Double(x)),
        ("y_seq", Values::Double(vec![BEGIN[1]; rows])),
        ("yaw_seq", Values::Double(vec![0.0; rows])),
        ("vx", Values::Float(vec![SPEED as f32; rows])),
        ("yaw_rate", Values::Float(vec![0.0; rows])),
    ]
}

/// `sensors.json`.
pub(crate) fn sensors() -> Value {
    let sensor = |(id, [x, y, yaw]): &(i32, [f64; 3])| {
        (format!("radar_{id}"), json!({"id": id, "x": x, "y": y, "yaw": yaw}))
    };
    RADARS.iter().map(sensor).collect::<serde_json::Map<_, _>>().into()
}

/// Writes a sequence's folder.
pub(crate) fn write_sequence(folder: &Path, sequence: &Sequence) {
    let tables = [("radar_data", &sequence.radar), ("odometry", &sequence.odometry)];
    write_tables(&folder.join("radar_data.h5"), &tables, 16);
    fs::write(folder.join("scenes.json"), sequence.scenes.to_string()).unwrap();
}

/// Writes a dataset of one sequence.
pub(crate) fn write_dataset(folder: &Path) {
    write_sequence(&folder.join("data/sequence_1"), &sequence(false));
    fs::write(folder.join("data/sensors.json"), sensors().to_string()).unwrap();
}
