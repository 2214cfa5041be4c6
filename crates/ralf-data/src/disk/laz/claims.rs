//! What a LAS or LAZ file claims of itself, checked before it is believed: what decompresses takes the memory that a
//! header asks for, and can't go on without the parts that it takes for granted.

use crate::error::DataError;
use std::path::Path;

/// Where the header has the second part of its version: 1 byte.
const MINOR_VERSION: usize = 25;
/// Its own length: 2 bytes.
const HEADER_SIZE: usize = 94;
/// Where the points begin: 4 bytes.
const POINTS_BEGIN: usize = 96;
/// How many records follow the header: 4 bytes.
const RECORDS: usize = 100;
/// The points' format, 1 byte; the highest bit is set where they are compressed.
const POINT_FORMAT: usize = 104;
/// The length of a point: 2 bytes.
const POINT_SIZE: usize = 105;
/// A record's user, 16 bytes, and number, 2 bytes.
const LASZIP: &[u8] = b"laszip encoded\0\0\xbc\x56";
/// What comes before the content of a record.
const RECORD_HEAD: usize = 54;

/// Refuses a file whose claims can't be true, or that says too little to be decompressed.
pub(super) fn check(file: &Path, bytes: &[u8]) -> Result<(), DataError> {
    let refused =
        |place: &str, expected: &str, found: String| Err(DataError::content(file, place, expected, found));
    let (Some([minor]), Some([format])) = (number(bytes, MINOR_VERSION), number(bytes, POINT_FORMAT)) else {
        return refused("header", "227 bytes or more", format!("{} bytes", bytes.len()));
    };
    // From 1.4 on, records of any length may follow the points.
    if minor > 3 {
        return refused("header", "LAS 1.0 to 1.3", format!("1.{minor}"));
    }
    if format & 0x80 == 0 {
        return Ok(());
    }
    match laszip_record(bytes).and_then(Compression::read) {
        Some(found) if found.is_of_points(short(bytes, POINT_SIZE)) => {}
        found => {
            let expected = "chunks of one size, and fields that make up a point";
            return refused("LASzip record", expected, format!("{found:?}"));
        }
    }
    match claimed_chunks(bytes) {
        Some(chunks) if chunks as usize <= bytes.len() => Ok(()),
        Some(chunks) => {
            let expected = format!("at most {} chunks, one per byte", bytes.len());
            refused("chunk table", &expected, chunks.to_string())
        }
        None => {
            let found = format!("none in {} bytes: the file is cut short", bytes.len());
            refused("chunk table", "the place of every chunk of points", found)
        }
    }
}

/// What the LASzip record says of compression.
#[derive(Debug)]
struct Compression {
    /// 2: point by point, in chunks.
    kind: u16,
    chunk_size: u32,
    /// Bytes of all fields of a point.
    point_size: Option<usize>,
}

impl Compression {
    fn read(record: &[u8]) -> Option<Self> {
        let fields = usize::from(short(record, 32)?);
        let sizes = (0..fields).map(|field| short(record, 36 + 6 * field).map(usize::from));
        let chunk_size = u32::from_le_bytes(number(record, 12)?);
        Some(Self { kind: short(record, 0)?, chunk_size, point_size: sizes.sum() })
    }

    fn is_of_points(&self, size: Option<u16>) -> bool {
        let whole = (1..u32::MAX).contains(&self.chunk_size);
        whole && self.kind == 2 && self.point_size.is_some() && self.point_size == size.map(usize::from)
    }
}

/// The content of the record that says how points are compressed.
fn laszip_record(bytes: &[u8]) -> Option<&[u8]> {
    let mut record = bytes.get(usize::from(short(bytes, HEADER_SIZE)?)..)?;
    for _ in 0..u32::from_le_bytes(number(bytes, RECORDS)?) {
        let content = record.get(RECORD_HEAD..)?;
        let length = usize::from(short(record, 20)?);
        if record.get(2..20)? == LASZIP {
            return content.get(..length);
        }
        record = content.get(length..)?;
    }
    None
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

fn short(bytes: &[u8], at: usize) -> Option<u16> {
    number(bytes, at).map(u16::from_le_bytes)
}

fn number<const N: usize>(bytes: &[u8], at: usize) -> Option<[u8; N]> {
    bytes.get(at..)?.first_chunk().copied()
}
