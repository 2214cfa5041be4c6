//! The one file with all scans of the radar.

use crate::disk::npy::records::Records;
use crate::error::DataError;
use crate::read::last_read::LastRead;
use std::ops::Range;
use std::path::Path;

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
    pub(super) rows: Vec<Range<usize>>,
    /// How many have rows of several times.
    pub(super) torn: usize,
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
                let place = format!("record {begin}");
                let expected = "a scan after the one before";
                return Err(DataError::content(file, place, expected, format!("{t_ns} ns")));
            }
            let end = begin + rows.len();
            found.torn += usize::from(times[begin..end].iter().any(|time| *time != t_ns));
            found.times.push(t_ns);
            found.rows.push(begin..end);
            begin = end;
        }
        Ok(found)
    }
}

/// The columns of the files that were read last, as [`RADAR_FIELDS`] has them.
pub(super) type RadarFiles = LastRead<Vec<Vec<f32>>>;

/// Of two sequences, for whoever goes from one to the next.
pub(super) fn radar_files() -> RadarFiles {
    LastRead::new(
        |file| {
            let records = Records::read(file)?;
            COLUMNS.iter().map(|name| records.column(name)).collect()
        },
        2,
    )
}

/// A scan out of its file's columns.
pub(super) fn scan(file: &Path, all: &[Vec<f32>], rows: &Range<usize>) -> Result<Vec<Vec<f32>>, DataError> {
    let cut = |column: &Vec<f32>| column.get(rows.clone()).map(<[f32]>::to_vec);
    let columns: Option<Vec<Vec<f32>>> = all.iter().map(cut).collect();
    columns.ok_or_else(|| {
        let found = "fewer than when it was opened";
        DataError::content(file, "data", format!("records {rows:?}"), found)
    })
}
