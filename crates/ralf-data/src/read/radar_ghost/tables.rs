//! The two tables of a file as they are needed.

use super::labels::truth;
use super::scans::{UNTOLD, nanoseconds, unit};
use crate::disk::hdf5::{Hdf5File, Table};
use crate::error::DataError;
use crate::read::instances::numbered;
use crate::read::row_scans::{Scan, scans};
use ralf::label::Cause;
use std::path::Path;
use std::sync::Arc;

/// The radar columns that are kept, and what they are called here.
pub(super) const COLUMNS: [(&str, &str); 6] = [
    ("phi_sc", "azimuth"),
    ("r_sc", "range"),
    ("vr_sc", "doppler"),
    ("amp", "amp"),
    ("x_cc", "x_cc"),
    ("y_cc", "y_cc"),
];
/// The radars, by the names that rows have for them.
pub(super) const RADARS: [&str; 2] = ["left", "right"];

/// All radar detections of a file.
pub(super) struct Detections {
    /// In the order of [`COLUMNS`].
    pub(super) columns: Vec<Vec<f32>>,
    /// SemanticKITTI id and cause of each; the error is the first number that the convention doesn't have.
    pub(super) truth: Result<Vec<(u16, Cause)>, String>,
    /// Which instance each belongs to, 0 for none.
    pub(super) instances: Vec<u16>,
    /// Of each of [`RADARS`].
    pub(super) scans: [Vec<Scan>; 2],
    /// How many scans have rows of several times.
    pub(super) torn: usize,
}

/// All LiDAR points of a file, in the car's frame.
pub(super) struct Points {
    pub(super) points: Vec<[f32; 3]>,
    pub(super) scans: Vec<Scan>,
}

/// Reads the radar's table.
pub(super) fn detections(file: &Path) -> Result<Detections, DataError> {
    let table = Hdf5File::open(file)?.table("radar")?;
    let sensors = sensors(file, &table)?;
    let times = table.numbers("timestamp")?;
    let unit = match unit_of_radar(file, &times, &sensors)? {
        Some(unit) => Some(unit),
        None => unit_of_lidar(file, &Hdf5File::open(file)?.table("lidar")?.numbers("timestamp")?)?,
    };
    let times = nanoseconds(file, "radar", &times, unit.unwrap_or(UNTOLD))?;
    let frames = table.integers("frame")?;
    let (mut of_radars, mut torn) = ([Vec::new(), Vec::new()], 0);
    for ((sensor, _), scan) in scans(sensors.iter().copied().zip(frames), &times) {
        torn += usize::from(scan.rows().any(|row| times[row] != scan.t_ns));
        of_radars[sensor].push(scan);
    }
    let columns = COLUMNS.iter().map(|(name, _)| table.floats(name)).collect::<Result<_, _>>()?;
    let (truth, instances) = (truths(&table)?, instances(&table)?);
    Ok(Detections { columns, truth, instances, scans: of_radars, torn })
}

/// The unit of the radar table's times: the steps of one radar tell it, for the other measures shortly after it. A
/// table of a single moment tells none, and has that of the other one.
fn unit_of_radar(file: &Path, times: &[f64], sensors: &[usize]) -> Result<Option<f64>, DataError> {
    let of_one = times.iter().zip(sensors).filter(|(_, sensor)| Some(*sensor) == sensors.first());
    unit(file, "radar", of_one.map(|(time, _)| *time))
}

/// The same of the LiDAR's table.
fn unit_of_lidar(file: &Path, times: &[f64]) -> Result<Option<f64>, DataError> {
    unit(file, "lidar", times.iter().copied())
}

/// Which of [`RADARS`] each row is of.
fn sensors(file: &Path, table: &Table) -> Result<Vec<usize>, DataError> {
    let place = |(row, name): (usize, &Arc<str>)| {
        RADARS.iter().position(|known| **known == **name).ok_or_else(|| {
            let place = format!("radar, sensor, row {row}");
            DataError::content(file, place, "`left` or `right`", format!("`{name}`"))
        })
    };
    table.texts("sensor")?.iter().enumerate().map(place).collect()
}

fn truths(table: &Table) -> Result<Result<Vec<(u16, Cause)>, String>, DataError> {
    let ids = table.integers("label_id")?;
    let groups = if table.has("group") { table.integers("group")? } else { vec![0; ids.len()] };
    let truth = |(row, (id, group)): (usize, (&i64, i64))| {
        truth(*id, group != 0).ok_or_else(|| format!("{id} in row {row}"))
    };
    Ok(ids.iter().zip(groups).enumerate().map(truth).collect())
}

/// Instances have numbers in the file, or else get some in the order in which their names appear.
fn instances(table: &Table) -> Result<Vec<u16>, DataError> {
    if !table.has("instance_id") {
        return Ok(vec![0; table.rows()]);
    }
    if let Ok(numbers) = table.numbers("instance_id") {
        let instance = |number: f64| if number > 0.0 && number <= 65_535.0 { number as u16 } else { 0 };
        return Ok(numbers.into_iter().map(instance).collect());
    }
    Ok(numbered(table.texts("instance_id")?))
}

/// Reads the LiDAR's table.
pub(super) fn points(file: &Path) -> Result<Points, DataError> {
    let table = Hdf5File::open(file)?.table("lidar")?;
    if table.has("x_sc") && !table.has("x_cc") {
        let reason = "this is version 1.0 of the data set, whose LiDAR times are off by some tenths of a second from \
                      those of the radars; version 1.1 (doi 10.5281/zenodo.6676246) puts that right";
        return Err(DataError::Unsuitable {
            file: file.into(),
            place: "lidar".into(),
            reason: reason.into(),
        });
    }
    let times = table.numbers("timestamp")?;
    let unit = match unit_of_lidar(file, &times)? {
        Some(unit) => Some(unit),
        None => {
            let radar = Hdf5File::open(file)?.table("radar")?;
            unit_of_radar(file, &radar.numbers("timestamp")?, &sensors(file, &radar)?)?
        }
    };
    let times = nanoseconds(file, "lidar", &times, unit.unwrap_or(UNTOLD))?;
    let scans = scans(times.iter().copied(), &times).into_iter().map(|(_, scan)| scan).collect();
    let [x, y, z] = [table.floats("x_cc")?, table.floats("y_cc")?, table.floats("z_cc")?];
    let points = x.into_iter().zip(y).zip(z).map(|((x, y), z)| [x, y, z]).collect();
    Ok(Points { points, scans })
}
