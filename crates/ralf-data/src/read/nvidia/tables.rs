//! A radar's table as it is needed.

use crate::disk::parquet_table::ParquetTable;
use crate::error::DataError;
use crate::read::point_times;
use crate::read::row_scans::{Scan, scans};
use std::path::Path;

/// The columns that are kept, and what they are called here.
pub(super) const COLUMNS: [(&str, &str); 8] = [
    ("azimuth", "azimuth"),
    ("elevation", "elevation"),
    ("distance", "range"),
    ("radial_velocity", "doppler"),
    ("rcs", "rcs"),
    ("snr", "snr"),
    ("exist_probb", "exist_probb"),
    ("doppler_ambiguity", "doppler_ambiguity"),
];

/// The most detections of a radar in a clip: ten thousand in each of its scans.
const MOST_DETECTIONS: usize = 1 << 22;

/// No radar takes longer for a scan, ns.
const LONGEST_CYCLE_NS: i64 = 200_000_000;

/// All scans of a radar.
pub(super) struct Scans {
    /// In the order of [`COLUMNS`].
    pub(super) columns: Vec<Vec<f32>>,
    /// In the order of time.
    pub(super) scans: Vec<Scan>,
    /// Whether any detection has an elevation.
    pub(super) has_elevation: bool,
}

/// Reads a radar's table.
pub(super) fn table(file: &Path) -> Result<Scans, DataError> {
    let table = ParquetTable::open(file, MOST_DETECTIONS)?;
    // What pandas calls an index that it has no name for.
    let index = if table.has("scan_index") { "scan_index" } else { "__index_level_0__" };
    let (indices, times) = (table.integers(index)?, table.microseconds("timestamp")?);
    let of_rows = times.iter().enumerate().map(|(row, time)| nanoseconds(file, row, *time));
    let mut scans =
        of_one_time(file, scans(indices.into_iter(), &of_rows.collect::<Result<Vec<_>, _>>()?), &times)?;
    move_to_when_measured(&table, &mut scans);
    scans.sort_by_key(|scan| (scan.t_ns, scan.rows().next()));
    let mut columns = COLUMNS.iter().map(|(name, _)| table.floats(name)).collect::<Result<Vec<_>, _>>()?;
    let has_elevation = columns[1].iter().any(|elevation| elevation.is_finite() && *elevation != 0.0);
    without_place(&mut columns);
    Ok(Scans { columns, scans, has_elevation })
}

/// Takes the coordinates from rows without a distance: at 0 they would lie in the radar itself, below it behind it.
fn without_place(columns: &mut [Vec<f32>]) {
    let [azimuth, elevation, distance, ..] = columns else { return };
    for ((azimuth, elevation), distance) in azimuth.iter_mut().zip(elevation).zip(distance) {
        if *distance <= 0.0 {
            [*azimuth, *elevation, *distance] = [f32::NAN; 3];
        }
    }
}

/// The scans, of which each has rows of one time.
fn of_one_time(file: &Path, found: Vec<(i64, Scan)>, times_us: &[i64]) -> Result<Vec<Scan>, DataError> {
    let scans: Vec<Scan> = found.into_iter().map(|(_, scan)| scan).collect();
    for scan in &scans {
        let time_us = scan.t_ns / 1000;
        if let Some(row) = scan.rows().find(|row| times_us[*row] != time_us) {
            let expected = format!("{time_us} us, as of the scan's first row");
            let place = format!("timestamp, row {row}");
            return Err(DataError::content(file, place, expected, times_us[row].to_string()));
        }
    }
    Ok(scans)
}

/// Moves scans from when their cycle began (`timestamp`) to the median of the times at which their rows were measured
/// (`sensor_timestamp`). A table that lacks those, or has them on another clock, keeps the former.
fn move_to_when_measured(table: &ParquetTable, scans: &mut [Scan]) {
    let Ok(measured_us) = table.microseconds("sensor_timestamp") else { return };
    let medians: Option<Vec<i64>> = scans.iter().map(|scan| median_ns(scan, &measured_us)).collect();
    if let Some(medians) = medians {
        scans.iter_mut().zip(medians).for_each(|(scan, t_ns)| scan.t_ns = t_ns);
    }
}

/// The median of a scan's rows; `None` unless all lie within a cycle that begins with the scan.
fn median_ns(scan: &Scan, measured_us: &[i64]) -> Option<i64> {
    let mut times =
        scan.rows().map(|row| point_times::nanoseconds(measured_us[row])).collect::<Option<Vec<_>>>()?;
    let within = |t_ns: &i64| (0..LONGEST_CYCLE_NS).contains(&t_ns.saturating_sub(scan.t_ns));
    if !times.iter().all(within) {
        return None;
    }
    times.sort_unstable();
    times.get(times.len() / 2).copied()
}

/// A time of a row as ns.
pub(super) fn nanoseconds(file: &Path, row: usize, time_us: i64) -> Result<i64, DataError> {
    point_times::nanoseconds(time_us).ok_or_else(|| {
        DataError::content(file, format!("timestamp, row {row}"), "a time in us", time_us.to_string())
    })
}
