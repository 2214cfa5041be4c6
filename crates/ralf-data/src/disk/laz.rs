//! LAS and LAZ point clouds whose points carry a time.

use crate::disk::files;
use crate::error::DataError;
use las::{PointDataBuilder, Reader};
use std::io::Cursor;
use std::path::Path;

/// The most points that a revolution can have. A damaged header claims any number.
const MOST_POINTS: u64 = 1 << 24;
/// Points that are decompressed at once.
const BATCH: u64 = 1 << 16;
/// Where the header says its version's second part.
const MINOR_VERSION: usize = 25;
/// Where it says where the points begin: 4 bytes.
const POINTS_BEGIN: usize = 96;
/// Where it says the points' format; the highest bit is set where they are compressed.
const POINT_FORMAT: usize = 104;

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
    check_claims(file, &bytes)?;
    let wrong =
        |error: las::Error| DataError::content(file, "content", "a LAS or LAZ file", error.to_string());
    let mut reader = Reader::new(Cursor::new(bytes)).map_err(wrong)?;
    let claimed = reader.header().number_of_points();
    if claimed > MOST_POINTS {
        let expected = format!("at most {MOST_POINTS} points");
        return Err(DataError::content(file, "header", expected, claimed.to_string()));
    }
    let wanted = claimed.min(most);
    let mut batch = PointDataBuilder::new().for_header(reader.header()).build();
    let mut points = Vec::new();
    while let Some(left) = wanted.checked_sub(points.len() as u64).filter(|left| *left > 0) {
        let found = reader.fill_points(BATCH.min(left), &mut batch).map_err(|error| {
            let place = format!("point {} and those after it", points.len());
            DataError::content(file, place, format!("{claimed} points in all"), error.to_string())
        })?;
        let Some(times) = batch.gps_time() else {
            let found = format!("format {}", batch.format());
            return Err(DataError::content(file, "header", "a point format with a time per point", found));
        };
        if found == 0 {
            let expected = format!("{claimed} points");
            return Err(DataError::content(file, "end", expected, points.len().to_string()));
        }
        let places = batch.x().zip(batch.y()).zip(batch.z());
        for ((((x, y), z), intensity), gps_time) in places.zip(batch.intensity()).zip(times) {
            points.push(LazPoint { place: [x, y, z], intensity, gps_time });
        }
    }
    Ok(points)
}

/// Refuses headers that ask for more memory than the file can be worth: what decompresses takes its word for it.
fn check_claims(file: &Path, bytes: &[u8]) -> Result<(), DataError> {
    let (Some(minor), Some(format)) = (bytes.get(MINOR_VERSION), bytes.get(POINT_FORMAT)) else {
        return Err(DataError::content(
            file,
            "header",
            "227 bytes or more",
            format!("{} bytes", bytes.len()),
        ));
    };
    // From 1.4 on, records of any length may follow the points.
    if *minor > 3 {
        return Err(DataError::content(file, "header", "LAS 1.0 to 1.3", format!("1.{minor}")));
    }
    let chunks = if format & 0x80 == 0 { None } else { claimed_chunks(bytes) };
    match chunks.filter(|chunks| *chunks as usize > bytes.len()) {
        Some(chunks) => {
            let expected = format!("at most {} chunks, one per byte", bytes.len());
            Err(DataError::content(file, "chunk table", expected, chunks.to_string()))
        }
        None => Ok(()),
    }
}

/// How many chunks of compressed points a file claims to have. The table of them lies where the first 8 bytes of the
/// points say, or else the last 8 bytes of the file, and has the number in its second 4 bytes.
fn claimed_chunks(bytes: &[u8]) -> Option<u32> {
    let begin = u64::from(number(bytes, POINTS_BEGIN).map(u32::from_le_bytes)?);
    let after = |place: [u8; 8]| u64::try_from(i64::from_le_bytes(place)).ok().filter(|place| *place > begin);
    let table = number(bytes, usize::try_from(begin).ok()?).and_then(after);
    let table = table.or_else(|| number(bytes, bytes.len().checked_sub(8)?).and_then(after))?;
    number(bytes, usize::try_from(table).ok()?.checked_add(4)?).map(u32::from_le_bytes)
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..)?.first_chunk().copied()
}
