//! LAS and LAZ point clouds whose points carry a time.

mod claims;

use crate::disk::files;
use crate::error::DataError;
use las::{PointData, PointDataBuilder, Reader};
use std::io::Cursor;
use std::panic::catch_unwind;
use std::path::Path;

/// The most points that a revolution can have. A damaged header claims any number.
const MOST_POINTS: u64 = 1 << 24;
/// Points that are decompressed at once.
const BATCH: u64 = 1 << 16;
/// A point as it lies in the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct LazPoint {
    /// In the file's frame and unit.
    pub(crate) place: [f64; 3],
    pub(crate) intensity: u16,
    /// Called so by the format, whatever clock and unit the recording keeps in it.
    pub(crate) gps_time: f64,
}

/// All points of a file. Refused: points without a time, and what is no such file or ends before its last point.
pub(crate) fn read(file: &Path) -> Result<Vec<LazPoint>, DataError> {
    read_up_to(file, MOST_POINTS)
}

/// The first point of a file, if it has any.
pub(crate) fn read_first(file: &Path) -> Result<Option<LazPoint>, DataError> {
    Ok(read_up_to(file, 1)?.first().copied())
}

fn read_up_to(file: &Path, most: u64) -> Result<Vec<LazPoint>, DataError> {
    let bytes = files::read(file)?;
    claims::check(file, &bytes)?;
    // What decompresses asserts some of what a damaged file can break, in builds that check assertions.
    catch_unwind(|| decompressed(file, bytes, most)).unwrap_or_else(|_| {
        Err(DataError::content(file, "points", "compressed points", "bytes that can't be decompressed"))
    })
}

fn decompressed(file: &Path, bytes: Vec<u8>, most: u64) -> Result<Vec<LazPoint>, DataError> {
    let wrong =
        |error: las::Error| DataError::content(file, "content", "a LAS or LAZ file", error.to_string());
    let mut reader = Reader::new(Cursor::new(bytes)).map_err(wrong)?;
    let claimed = reader.header().number_of_points();
    if claimed > MOST_POINTS {
        let expected = format!("at most {MOST_POINTS} points");
        return Err(DataError::content(file, "header", expected, claimed.to_string()));
    }
    let mut batch = PointDataBuilder::new().for_header(reader.header()).build();
    let mut points = Vec::new();
    let mut left = claimed.min(most);
    while left > 0 {
        let found = reader.fill_points(BATCH.min(left), &mut batch).map_err(|error| {
            let place = format!("point {} and those after it", points.len());
            DataError::content(file, place, format!("{claimed} points in all"), error.to_string())
        })?;
        if found == 0 {
            let expected = format!("{claimed} points");
            return Err(DataError::content(file, "end", expected, points.len().to_string()));
        }
        add(file, &batch, &mut points)?;
        left = left.saturating_sub(found);
    }
    Ok(points)
}

fn add(file: &Path, batch: &PointData, points: &mut Vec<LazPoint>) -> Result<(), DataError> {
    let Some(times) = batch.gps_time() else {
        let found = format!("format {}", batch.format());
        return Err(DataError::content(file, "header", "a point format with a time per point", found));
    };
    let places = batch.x().zip(batch.y()).zip(batch.z());
    for ((((x, y), z), intensity), gps_time) in places.zip(batch.intensity()).zip(times) {
        points.push(LazPoint { place: [x, y, z], intensity, gps_time });
    }
    Ok(())
}
