//! The text tables of a sequence: `timestamps.txt`, `odometry.csv`, `poses.csv`.

use super::values::quaternion_xyzw;
use crate::disk::files;
use crate::error::DataError;
use ralf::space::{OdometrySample, PoseSample, transform_from_parts};
use ralf_files::Kind;
use std::fmt::Write;
use std::path::Path;

/// Header of `odometry.csv`.
const ODOMETRY: [&str; 3] = ["t_ns", "v_mps", "yaw_rate_radps"];
/// Header of `poses.csv`.
const POSES: [&str; 8] = ["t_ns", "x", "y", "z", "qx", "qy", "qz", "qw"];
/// Times lie within 146 years of 0, so that the difference of two is a time as well.
const LATEST_NS: i64 = i64::MAX / 2;

/// The times in a `timestamps.txt`, one per line, none before the one above.
pub(crate) fn read_timestamps(file: &Path) -> Result<Vec<i64>, DataError> {
    let mut order = Order { file, latest: None };
    let text = files::read_text(file, Kind::Table)?;
    (1..).zip(text.trim_end().lines()).map(|(line, text)| order.next(line, text)).collect()
}

/// The bytes of a `timestamps.txt`.
pub(crate) fn timestamps_text(times: &[i64]) -> String {
    times.iter().fold(String::new(), |mut text, time| {
        // Writing to a string can't fail.
        let _ = writeln!(text, "{time}");
        text
    })
}

/// The rows of an `odometry.csv`.
pub(crate) fn read_odometry(file: &Path) -> Result<Vec<OdometrySample>, DataError> {
    let sample = |row: Row<2>| {
        let [velocity, yaw_rate] = row.values;
        Ok(OdometrySample { t_ns: row.t_ns, velocity, yaw_rate })
    };
    read_rows(file, &ODOMETRY)?.into_iter().map(sample).collect()
}

/// The bytes of an `odometry.csv`.
pub(crate) fn odometry_text(samples: &[OdometrySample]) -> String {
    table(&ODOMETRY, samples.iter().map(|s| (s.t_ns, [s.velocity, s.yaw_rate])))
}

/// The rows of a `poses.csv`.
pub(crate) fn read_poses(file: &Path) -> Result<Vec<PoseSample>, DataError> {
    let sample = |row: Row<7>| {
        let [x, y, z, qx, qy, qz, qw] = row.values;
        let pose = transform_from_parts([x, y, z], [qx, qy, qz, qw]);
        let odom_from_vehicle = pose.ok_or_else(|| {
            let found = format!("{qx}, {qy}, {qz}, {qw}");
            DataError::content(file, format!("line {}", row.line), "qx, qy, qz, qw of length 1", found)
        })?;
        Ok(PoseSample { t_ns: row.t_ns, odom_from_vehicle })
    };
    read_rows(file, &POSES)?.into_iter().map(sample).collect()
}

/// The bytes of a `poses.csv`.
pub(crate) fn poses_text(samples: &[PoseSample]) -> String {
    let row = |sample: &PoseSample| {
        let [x, y, z]: [f64; 3] = sample.odom_from_vehicle.translation.vector.into();
        let [qx, qy, qz, qw] = quaternion_xyzw(&sample.odom_from_vehicle.rotation);
        (sample.t_ns, [x, y, z, qx, qy, qz, qw])
    };
    table(&POSES, samples.iter().map(row))
}

/// A row of a table whose first column is the time.
struct Row<const N: usize> {
    line: u64,
    t_ns: i64,
    values: [f64; N],
}

/// The rows below the header. Lines are split here, for the csv crate miscounts them where they end in CR LF.
fn read_rows<const N: usize>(file: &Path, names: &[&str]) -> Result<Vec<Row<N>>, DataError> {
    let text = files::read_text(file, Kind::Table)?;
    let mut lines = (1..).zip(text.lines());
    let header = lines.next().map_or("", |(_, text)| text);
    if !header.split(',').map(str::trim).eq(names.iter().copied()) {
        return Err(DataError::content(
            file,
            "line 1",
            format!("`{}`", names.join(",")),
            format!("`{header}`"),
        ));
    }
    let mut order = Order { file, latest: None };
    lines.map(|(line, text)| row(&mut order, names, line, text)).collect()
}

fn row<const N: usize>(
    order: &mut Order<'_>,
    names: &[&str],
    line: u64,
    text: &str,
) -> Result<Row<N>, DataError> {
    let file = order.file;
    let cells: Vec<&str> = text.split(',').map(str::trim).collect();
    if cells.len() != names.len() {
        let expected = format!("{} values", names.len());
        return Err(DataError::content(file, format!("line {line}"), expected, cells.len().to_string()));
    }
    let t_ns = order.next(line, cells[0])?;
    let mut values = [0.0; N];
    for ((value, cell), name) in values.iter_mut().zip(&cells[1..]).zip(&names[1..]) {
        *value = number(cell).ok_or_else(|| {
            DataError::content(file, format!("line {line}, {name}"), "a finite number", format!("`{cell}`"))
        })?;
    }
    Ok(Row { line, t_ns, values })
}

fn number(cell: &str) -> Option<f64> {
    cell.parse().ok().filter(|value: &f64| value.is_finite())
}

fn table<const N: usize>(names: &[&str], rows: impl Iterator<Item = (i64, [f64; N])>) -> String {
    let mut text = names.join(",") + "\n";
    for (t_ns, values) in rows {
        let cells = values.map(|value| format!(",{value}")).concat();
        // Writing to a string can't fail.
        let _ = writeln!(text, "{t_ns}{cells}");
    }
    text
}

/// Reads times and refuses one that goes back.
struct Order<'a> {
    file: &'a Path,
    latest: Option<i64>,
}

impl Order<'_> {
    fn next(&mut self, line: u64, text: &str) -> Result<i64, DataError> {
        let wrong = |expected: String| {
            Err(DataError::content(self.file, format!("line {line}"), expected, format!("`{text}`")))
        };
        let Some(t_ns) = text.trim().parse().ok().filter(|t_ns| (-LATEST_NS..=LATEST_NS).contains(t_ns))
        else {
            return wrong(format!("a time, as whole nanoseconds between -{LATEST_NS} and {LATEST_NS}"));
        };
        if let Some(latest) = self.latest.filter(|latest| t_ns < *latest) {
            return wrong(format!("a time of {latest} or later, as in the line above"));
        }
        self.latest = Some(t_ns);
        Ok(t_ns)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use tempfile::NamedTempFile;

    fn file(text: &str) -> NamedTempFile {
        let file = NamedTempFile::new().unwrap();
        std::fs::write(file.path(), text).unwrap();
        file
    }

    #[test]
    fn line_ends_of_any_kind_and_equal_times_are_fine() {
        for text in ["-5\n-5\n7\n", "-5\n-5\n7", "-5\r\n-5\r\n7\r\n", "\u{feff}-5\n-5\n7\n\n"] {
            assert_eq!(read_timestamps(file(text).path()).unwrap(), [-5, -5, 7]);
        }
        assert_eq!(timestamps_text(&[-5, 7]), "-5\n7\n");
        let samples = read_odometry(file("t_ns, v_mps, yaw_rate_radps\r\n1,2.5,-0.5\r\n").path()).unwrap();
        assert_eq!(samples, [OdometrySample { t_ns: 1, velocity: 2.5, yaw_rate: -0.5 }]);
    }

    #[test]
    fn written_is_read_back() {
        let samples = [OdometrySample { t_ns: 3, velocity: 0.1 + 0.2, yaw_rate: 1e-300 }];
        assert_eq!(read_odometry(file(&odometry_text(&samples)).path()).unwrap(), samples);
        let pose = transform_from_parts([1.0, -2.0, 1.0 / 3.0], [0.1, 0.2, 0.3, 0.927]).unwrap();
        let samples = [PoseSample { t_ns: 3, odom_from_vehicle: pose }];
        assert_eq!(read_poses(file(&poses_text(&samples)).path()).unwrap(), samples);
    }

    #[test]
    fn bad_lines_are_named() {
        let timestamps = |text: &str| read_timestamps(file(text).path()).map(drop);
        let odometry =
            |rows: &str| read_odometry(file(&format!("t_ns,v_mps,yaw_rate_radps\n{rows}")).path()).map(drop);
        let poses =
            |rows: &str| read_poses(file(&format!("t_ns,x,y,z,qx,qy,qz,qw\n{rows}")).path()).map(drop);
        for (result, part) in [
            (timestamps("5\n4\n"), "line 2: expected a time of 5 or later, as in the line above, found `4`"),
            (timestamps("5\n\n6\n"), "line 2: expected a time"),
            (timestamps("1.5\n"), "found `1.5`"),
            (timestamps("-9223372036854775808\n"), "line 1: expected a time"),
            (odometry("1,2,3\n2,NaN,0\n"), "line 3, v_mps: expected a finite number, found `NaN`"),
            (odometry("1,2,inf\n"), "line 2, yaw_rate_radps"),
            (odometry("1,2\n"), "line 2: expected 3 values, found 2"),
            (odometry("2,0,0\n1,0,0\n"), "line 3: expected a time of 2 or later"),
            (odometry("2,0,0\r\n3,0,0\r\n1,0,0"), "line 4: expected a time of 3 or later"),
            (poses("1,0,0,0,0,0,0,0\n"), "line 2: expected qx, qy, qz, qw of length 1, found 0, 0, 0, 0"),
            (read_poses(file("t,x\n").path()).map(drop), "line 1: expected `t_ns,x,y,z,qx,qy,qz,qw`"),
            (read_odometry(file("").path()).map(drop), "line 1: expected `t_ns,v_mps,yaw_rate_radps`"),
        ] {
            let error = result.unwrap_err().to_string();
            assert!(error.contains(part), "{error} lacks {part}");
        }
    }
}
