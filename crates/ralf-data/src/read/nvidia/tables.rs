//! A radar's table as it is needed.

use crate::disk::parquet_table::ParquetTable;
use crate::error::DataError;
use crate::read::point_times;
use std::ops::Range;
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

/// All scans of a radar.
pub(super) struct Scans {
    /// In the order of [`COLUMNS`].
    pub(super) columns: Vec<Vec<f32>>,
    /// Time, ns, and rows of each scan, in the order of time.
    pub(super) scans: Vec<(i64, Range<usize>)>,
    /// Whether any detection has an elevation.
    pub(super) has_elevation: bool,
}

/// Reads a radar's table.
pub(super) fn scans(file: &Path) -> Result<Scans, DataError> {
    let table = ParquetTable::open(file)?;
    // What pandas calls an index that it has no name for.
    let index = if table.has("scan_index") { "scan_index" } else { "__index_level_0__" };
    let (indices, times) = (table.integers(index)?, table.integers("timestamp")?);
    let mut scans: Vec<(i64, Range<usize>)> = Vec::new();
    for (row, (scan, time)) in indices.iter().zip(&times).enumerate() {
        let t_ns = nanoseconds(file, row, *time)?;
        match scans.last_mut() {
            Some((known, rows)) if indices[rows.start] == *scan => {
                if *known != t_ns {
                    let expected = format!("{} us, as of the scan's first row", *known / 1000);
                    let place = format!("timestamp, row {row}");
                    return Err(DataError::content(file, place, expected, time.to_string()));
                }
                rows.end = row + 1;
            }
            _ => scans.push((t_ns, row..row + 1)),
        }
    }
    scans.sort_by_key(|(t_ns, rows)| (*t_ns, rows.start));
    let columns = COLUMNS.iter().map(|(name, _)| table.floats(name)).collect::<Result<Vec<_>, _>>()?;
    let has_elevation = columns[1].iter().any(|elevation| elevation.is_finite() && *elevation != 0.0);
    Ok(Scans { columns, scans, has_elevation })
}

/// A time of a row as ns.
pub(super) fn nanoseconds(file: &Path, row: usize, time_us: i64) -> Result<i64, DataError> {
    point_times::nanoseconds(time_us).ok_or_else(|| {
        DataError::content(file, format!("timestamp, row {row}"), "a time in us", time_us.to_string())
    })
}
