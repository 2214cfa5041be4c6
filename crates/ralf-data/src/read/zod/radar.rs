//! The one file with all scans of the radar.

use crate::disk::npy::records::Records;
use crate::error::DataError;
use std::ops::Range;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// What a row becomes.
pub(super) const RADAR_FIELDS: [&str; 8] =
    ["range", "azimuth", "elevation", "doppler", "amplitude", "validity", "mode", "quality"];
/// The same in the file.
const COLUMNS: [&str; 8] = [
    "radar_range",
    "azimuth_angle",
    "elevation_angle",
    "range_rate",
    "amplitude",
    "validity",
    "mode",
    "quality",
];

/// The scans of a file: when they were, and which rows each has.
#[derive(Default)]
pub(super) struct Scans {
    pub(super) times: Vec<i64>,
    rows: Vec<Range<usize>>,
    /// The columns of the file, as long as its scans are asked for in a row.
    columns: Mutex<Option<Vec<Vec<f32>>>>,
}

impl Scans {
    /// Rows in a row with the same `scan_index` are a scan, of the time of its first row.
    pub(super) fn find(file: &Path) -> Result<Self, DataError> {
        let records = Records::read(file)?;
        let (scan, times) = (records.integers("scan_index")?, records.integers("timestamp")?);
        let mut found = Self::default();
        let mut begin = 0;
        for rows in scan.chunk_by(|a, b| a == b) {
            let t_ns = times[begin];
            if found.times.last().is_some_and(|before| t_ns <= *before) {
                let expected = "a scan after the one before".to_owned();
                return Err(DataError::content(
                    file,
                    format!("record {begin}"),
                    expected,
                    format!("{t_ns} ns"),
                ));
            }
            found.times.push(t_ns);
            found.rows.push(begin..begin + rows.len());
            begin += rows.len();
        }
        Ok(found)
    }

    /// The columns of a scan, as [`RADAR_FIELDS`] has them. A file is read once, and let go with its last scan.
    pub(super) fn columns(&self, file: &Path, scan: usize) -> Result<Vec<Vec<f32>>, DataError> {
        let mut known = self.columns.lock().unwrap_or_else(PoisonError::into_inner);
        let all = match known.take() {
            Some(all) => all,
            None => {
                let records = Records::read(file)?;
                COLUMNS.iter().map(|name| records.column(name)).collect::<Result<Vec<_>, _>>()?
            }
        };
        let rows = self.rows[scan].clone();
        let cut = |column: &Vec<f32>| column.get(rows.clone()).map(<[f32]>::to_vec);
        let scanned: Option<Vec<Vec<f32>>> = all.iter().map(cut).collect();
        if scan + 1 < self.rows.len() {
            *known = Some(all);
        }
        scanned.ok_or_else(|| {
            let found = "fewer than when it was opened";
            DataError::content(file, format!("scan {scan}"), format!("records {rows:?}"), found)
        })
    }
}
