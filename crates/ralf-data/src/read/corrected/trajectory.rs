//! Poses that another program estimated: TUM and KITTI files.
//!
//! - TUM: a pose per line, `t x y z qx qy qz qw`, times in seconds, quaternions with w last; lines that begin with
//!   `#` are comments.
//! - KITTI: a pose per line, the twelve numbers of a 3 x 4 matrix, row by row. It has no times: the n-th pose belongs
//!   to the n-th measurement of a sensor.
//!
//! A file tells of one sequence; a folder of files, named as the sequences are, of several.

use crate::disk::files;
use crate::error::DataError;
use crate::read::corrections::MotionSettings;
use nalgebra::{Matrix3, Rotation3, Translation3, UnitQuaternion};
use ralf::sensors::Sequence;
use ralf::space::{EgoMotion, PoseSample, Transform, transform_from_parts};
use ralf_files::Kind;
use std::path::{Path, PathBuf};

/// How the files of a folder of trajectories end.
const ENDINGS: [&str; 3] = ["tum", "txt", "kitti"];

/// A pose as it lies in a file, and its time where it has one, ns.
struct Row {
    line: usize,
    t_ns: Option<i64>,
    pose: Transform,
}

/// The file that tells of one of so many sequences. A single file is never taken for that of several: their times may
/// be the same, and nothing would tell.
pub(super) fn file_of(place: &Path, sequence: &str, sequences: usize) -> Result<PathBuf, DataError> {
    if !place.is_dir() {
        if sequences > 1 {
            let expected = "one sequence, or a folder with a file for each, such as";
            let (expected, found) = (format!("{expected} {sequence}.tum"), format!("{sequences} sequences"));
            return Err(DataError::content(place, "what it is the motion of", expected, found));
        }
        return Ok(place.to_owned());
    }
    let names = ENDINGS.map(|ending| format!("{sequence}.{ending}"));
    let mut there = Vec::new();
    for name in &names {
        there.extend(Some(name).filter(|_| files::exists(&place.join(name)).unwrap_or(true)));
    }
    match there[..] {
        [name] => Ok(place.join(name)),
        _ => {
            let found = match there[..] {
                [one, other, ..] => format!("{one} and {other}"),
                _ => "none of these".to_owned(),
            };
            let expected = format!("its poses in one of the files {}", names.join(", "));
            Err(DataError::content(place, format!("sequence {sequence}"), expected, found))
        }
    }
}

/// The motion that a file tells of a sequence.
pub(super) fn read(
    file: &Path,
    settings: &MotionSettings,
    sequence: &Sequence,
) -> Result<EgoMotion, DataError> {
    let rows = rows(file)?;
    let sensor_from_vehicle = mounting(file, settings, sequence)?.inverse();
    let order = order(file, settings, sequence, &rows)?;
    let mut poses = Vec::with_capacity(rows.len());
    for (i, row) in rows.iter().enumerate() {
        let t_ns = match order {
            Some(times) => times[i],
            None => row.t_ns.unwrap_or_default(),
        };
        poses.push(PoseSample { t_ns, odom_from_vehicle: row.pose * sensor_from_vehicle });
    }
    if let Some(i) = poses.windows(2).position(|pair| pair[1].t_ns <= pair[0].t_ns) {
        let place = format!("line {} (sequence {})", rows[i + 1].line, sequence.name);
        return Err(DataError::content(file, place, "a time after that of the line before", "none"));
    }
    EgoMotion::new(vec![], poses).ok_or_else(|| DataError::content(file, "content", "poses", "none"))
}

fn rows(file: &Path) -> Result<Vec<Row>, DataError> {
    let text = files::read_text(file, Kind::Table)?;
    let lines = text.lines().enumerate().map(|(i, line)| (i + 1, line.trim()));
    let filled = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    filled.map(|(line, text)| row(file, line, text)).collect()
}

fn row(file: &Path, line: usize, text: &str) -> Result<Row, DataError> {
    let place = || format!("line {line}");
    let words: Vec<&str> = text.split([' ', '\t', ',']).filter(|word| !word.is_empty()).collect();
    let mut values = Vec::with_capacity(words.len());
    for word in &words {
        let value = word.parse::<f64>().ok().filter(|value| value.is_finite());
        values.push(
            value.ok_or_else(|| DataError::content(file, place(), "finite numbers", format!("`{word}`")))?,
        );
    }
    let (t_ns, pose) = match values[..] {
        [_, x, y, z, qx, qy, qz, qw] => {
            let t_ns = nanoseconds(words[0]).ok_or_else(|| {
                DataError::content(
                    file,
                    place(),
                    "a time in seconds, 64 bits of ns",
                    format!("`{}`", words[0]),
                )
            })?;
            (Some(t_ns), transform_from_parts([x, y, z], [qx, qy, qz, qw]))
        }
        [a, b, c, x, d, e, f, y, g, h, i, z] => {
            (None, matrix_pose(&Matrix3::new(a, b, c, d, e, f, g, h, i), [x, y, z]))
        }
        _ => {
            let expected = "8 numbers (TUM: t x y z qx qy qz qw) or 12 (KITTI: a 3 x 4 matrix)";
            return Err(DataError::content(file, place(), expected, format!("{} numbers", values.len())));
        }
    };
    let pose = pose.ok_or_else(|| DataError::content(file, place(), "a rotation", "none"))?;
    Ok(Row { line, t_ns, pose })
}

/// A time in seconds as nanoseconds, digit by digit: as a float, times of today are off by a hundred of them.
fn nanoseconds(seconds: &str) -> Option<i64> {
    let (whole, fraction) = seconds.split_once('.').unwrap_or((seconds, ""));
    let negative = whole.starts_with('-');
    match (whole.parse::<i64>(), fraction.bytes().all(|digit| digit.is_ascii_digit())) {
        (Ok(whole), true) => {
            let digits: String = fraction.chars().chain("000000000".chars()).take(9).collect();
            let part = digits.parse::<i64>().ok()?;
            whole.checked_mul(1_000_000_000)?.checked_add(if negative { -part } else { part })
        }
        // Such as 1.6e9, which can't be more exact than a float.
        _ => {
            let t_ns = (seconds.parse::<f64>().ok()? * 1e9).round();
            (t_ns.abs() < i64::MAX as f64).then_some(t_ns as i64)
        }
    }
}

fn matrix_pose(matrix: &Matrix3<f64>, place: [f64; 3]) -> Option<Transform> {
    let off = (matrix * matrix.transpose() - Matrix3::identity()).abs().max();
    (off < 0.01 && matrix.determinant() > 0.0).then(|| {
        let rotation = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix(matrix));
        Transform::from_parts(Translation3::from(place), rotation)
    })
}

/// From the frame whose poses they are to the vehicle's.
fn mounting(file: &Path, settings: &MotionSettings, sequence: &Sequence) -> Result<Transform, DataError> {
    let Some(name) = settings.trajectory_frame.as_deref().filter(|name| *name != "vehicle") else {
        return Ok(Transform::identity());
    };
    let rig = &sequence.rig;
    let radars = rig.radars.iter().map(|radar| (&radar.name, radar.vehicle_from_radar));
    let lidars = rig.lidars.iter().map(|lidar| (&lidar.name, lidar.vehicle_from_lidar));
    let cameras = rig.cameras.iter().map(|camera| (&camera.name, camera.vehicle_from_camera));
    let found = radars.chain(lidars).chain(cameras).find(|(own, _)| *own == name);
    found.map(|(_, mount)| mount).ok_or_else(|| no_sensor(file, "motion.trajectory_frame", name, sequence))
}

fn no_sensor(file: &Path, key: &str, name: &str, sequence: &Sequence) -> DataError {
    let expected = format!("`vehicle` or the name of a sensor of sequence {}", sequence.name);
    DataError::content(file, key, expected, format!("`{name}`"))
}

/// The times of poses that have none: those of the sensor that is named, else of the only LiDAR. `None` where they
/// have times.
fn order<'a>(
    file: &Path,
    settings: &MotionSettings,
    sequence: &'a Sequence,
    rows: &[Row],
) -> Result<Option<&'a [i64]>, DataError> {
    let times = match &settings.trajectory_order {
        Some(name) => {
            let times = times_of(sequence, name);
            Some(times.ok_or_else(|| no_sensor(file, "motion.trajectory_order", name, sequence))?)
        }
        None if rows.iter().all(|row| row.t_ns.is_some()) => None,
        None => Some(sequence.times.lidars.first().map(Vec::as_slice).unwrap_or_default()),
    };
    match times {
        Some(times) if times.len() != rows.len() => {
            let of = settings.trajectory_order.as_deref().unwrap_or("the first LiDAR");
            let place = format!("sequence {}", sequence.name);
            let expected = format!("{} poses, one per measurement of {of}", times.len());
            Err(DataError::content(file, place, expected, format!("{} poses", rows.len())))
        }
        times => Ok(times),
    }
}

fn times_of<'a>(sequence: &'a Sequence, name: &str) -> Option<&'a [i64]> {
    let (rig, times) = (&sequence.rig, &sequence.times);
    let radars = rig.radars.iter().map(|radar| &radar.name).zip(&times.radars);
    let lidars = rig.lidars.iter().map(|lidar| &lidar.name).zip(&times.lidars);
    let cameras = rig.cameras.iter().map(|camera| &camera.name).zip(&times.cameras);
    let found = radars.chain(lidars).chain(cameras).find(|(own, _)| *own == name);
    found.map(|(_, times)| times.as_slice())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::PathBuf;

    fn parsed(text: &str) -> Result<Vec<Row>, String> {
        let folder = tempfile::tempdir().unwrap();
        let file: PathBuf = folder.path().join("poses.txt");
        std::fs::write(&file, text).unwrap();
        rows(&file).map_err(|error| error.to_string())
    }

    #[test]
    fn a_line_of_tum_and_one_of_kitti_are_the_same_pose() {
        // A quarter turn to the left, 3 m ahead.
        let half = 0.5_f64.sqrt();
        let tum =
            parsed(&format!("# time x y z qx qy qz qw\n1600000000.25 3 0 0 0 0 {half} {half}\n")).unwrap();
        let kitti = parsed("0 -1 0 3 1 0 0 0 0 0 1 0\n").unwrap();
        assert_eq!(tum[0].t_ns, Some(1_600_000_000_250_000_000));
        assert_eq!((tum[0].line, kitti[0].t_ns), (2, None));
        let marked = parsed("\u{feff}12 3 0 0 0 0 0 1\n").unwrap();
        assert_eq!((marked[0].line, marked[0].t_ns), (1, Some(12_000_000_000)));
        assert!((tum[0].pose.to_homogeneous() - kitti[0].pose.to_homogeneous()).abs().max() < 1e-12);
    }

    #[test]
    fn times_keep_their_nanoseconds() {
        let times = ["1600000000.123456789", "-0.5", "12", "3.0000000019", "1.5e1"].map(nanoseconds);
        let expected =
            [1_600_000_000_123_456_789, -500_000_000, 12_000_000_000, 3_000_000_001, 15_000_000_000];
        assert_eq!(times, expected.map(Some));
        assert_eq!(["9e30", "99999999999.0", "x"].map(nanoseconds), [None; 3]);
    }

    #[test]
    fn what_is_no_pose_is_refused_with_its_line() {
        let refused = |text: &str| parsed(text).map(|_| ()).unwrap_err();
        assert!(refused("1 2 3\n").contains("line 1") && refused("1 2 3\n").contains("3 numbers"));
        assert!(refused("0 0 0 0 0 0 0 1\n1 0 0 nan 0 0 0 1").contains("line 2"));
        assert!(refused("0 0 0 0 0 0 0 0\n").contains("a rotation"));
        assert!(refused("1 0 0 0 0 1 0 0 0 0 -1 0\n").contains("a rotation"));
    }
}
