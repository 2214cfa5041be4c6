//! Point clouds as the Point Cloud Library stores them: PCD 0.7, `ascii`, `binary` or `binary_compressed`. Values are
//! read by the names of their fields, as the header declares them.

mod header;

use crate::disk::{files, lzf};
use crate::error::DataError;
use header::{Data, Field, Header};
use std::path::Path;

/// The most bytes that the points of a file may take, decompressed: what a damaged header claims isn't believed.
const MOST_BYTES: usize = 1 << 30;

/// A cloud's bytes with what its header says of them.
pub(crate) struct Pcd<'a> {
    file: &'a Path,
    fields: Vec<Field>,
    records: usize,
    /// Record by record, or field by field.
    by_field: bool,
    record_bytes: usize,
    body: Vec<u8>,
}

impl<'a> Pcd<'a> {
    /// Reads a file. Errors name the header's line or the byte at which the data ends. What follows the points
    /// (nuScenes pads with zeros) is no part of the cloud.
    pub(crate) fn read(file: &'a Path) -> Result<Self, DataError> {
        let bytes = files::read(file)?;
        let header = Header::parse(file, &bytes)?;
        let (fields, record_bytes) = header.fields()?;
        let records = header.records()?;
        let size = records.checked_mul(record_bytes).filter(|size| *size <= MOST_BYTES).ok_or_else(|| {
            let expected = format!("at most {MOST_BYTES} bytes of points");
            DataError::content(file, "POINTS", expected, format!("{records} of {record_bytes} bytes"))
        })?;
        let body = &bytes[header.length..];
        let body = match header.data {
            Data::Ascii => ascii(file, body, &fields, records)?,
            Data::Binary => binary(file, &header, body, records, record_bytes)?,
            Data::Compressed => compressed(file, header.length, body, size)?,
        };
        let by_field = header.data == Data::Compressed;
        Ok(Self { file, fields, records, by_field, record_bytes, body })
    }

    /// All values of a field, in the order of the records; the nearest float32 of what it doesn't hold exactly.
    pub(crate) fn column(&self, name: &str) -> Result<Vec<f32>, DataError> {
        let field = self.field(name)?;
        Ok(self.bytes(field).map(|bytes| field.number.value(bytes) as f32).collect())
    }

    /// The whole numbers of a field.
    pub(crate) fn integers(&self, name: &str) -> Result<Vec<i64>, DataError> {
        let field = self.field(name)?;
        let wrong = |(record, found)| {
            let place = format!("point {record}, `{name}`");
            DataError::content(self.file, place, "a whole number of at most 63 bits", found)
        };
        let number = |(record, bytes)| field.number.integer(bytes).map_err(|found| wrong((record, found)));
        self.bytes(field).enumerate().map(number).collect()
    }

    fn field(&self, name: &str) -> Result<&Field, DataError> {
        self.fields.iter().find(|field| field.name == name).ok_or_else(|| {
            let found: Vec<_> = self.fields.iter().map(|field| field.name.as_str()).collect();
            DataError::content(self.file, "FIELDS", format!("a field `{name}`"), found.join(" "))
        })
    }

    /// The bytes of a field's values.
    fn bytes<'b>(&'b self, field: &'b Field) -> impl Iterator<Item = &'b [u8]> {
        let size = field.number.size();
        let (start, step) = if self.by_field {
            (field.offset * self.records, size)
        } else {
            (field.offset, self.record_bytes)
        };
        (0..self.records).map(move |record| &self.body[start + record * step..][..size])
    }
}

/// Records as they lie in the file.
fn binary(
    file: &Path,
    header: &Header,
    body: &[u8],
    records: usize,
    record_bytes: usize,
) -> Result<Vec<u8>, DataError> {
    match body.get(..records * record_bytes) {
        Some(points) => Ok(points.to_vec()),
        None => {
            let start = header.length;
            let expected = format!("{records} records of {record_bytes} bytes from byte {start} on");
            let place = format!("byte {}", start + body.len());
            Err(DataError::content(file, place, expected, "the end of the file"))
        }
    }
}

/// Two sizes, then what LZF made of all values, field by field.
fn compressed(file: &Path, start: usize, body: &[u8], size: usize) -> Result<Vec<u8>, DataError> {
    if size == 0 {
        return Ok(Vec::new());
    }
    let wrong = |at: usize, expected: &str, found: String| {
        Err(DataError::content(file, format!("byte {}", start + at), expected, found))
    };
    let Some(([packed, unpacked], rest)) = sizes(body) else {
        return wrong(body.len(), "two sizes of 4 bytes", "the end of the file".to_owned());
    };
    if unpacked != size {
        return wrong(4, &format!("{size} bytes, as many as the points take"), unpacked.to_string());
    }
    let Some(packed) = rest.get(..packed) else {
        return wrong(body.len(), &format!("{packed} compressed bytes"), format!("{} of them", rest.len()));
    };
    match lzf::exactly(packed, size) {
        Some(points) => Ok(points),
        None => wrong(8, &format!("{size} bytes, compressed by LZF"), "others".to_owned()),
    }
}

fn sizes(body: &[u8]) -> Option<([usize; 2], &[u8])> {
    let (packed, rest) = body.split_first_chunk()?;
    let (unpacked, rest) = rest.split_first_chunk()?;
    Some(([packed, unpacked].map(|size| u32::from_le_bytes(*size) as usize), rest))
}

/// The records of lines of numbers, as the same records are in a binary file.
fn ascii(file: &Path, body: &[u8], fields: &[Field], records: usize) -> Result<Vec<u8>, DataError> {
    let text = std::str::from_utf8(body)
        .map_err(|error| DataError::content(file, "points", "text", format!("other bytes: {error}")))?;
    let mut words = text.split_ascii_whitespace();
    let mut points = Vec::new();
    for record in 0..records {
        for field in fields {
            let word = words.next().unwrap_or_default();
            if field.number.append(word, &mut points).is_none() {
                let place = format!("point {record}, `{}`", field.name);
                let found =
                    if word.is_empty() { "the end of the file".to_owned() } else { format!("`{word}`") };
                return Err(DataError::content(file, place, "a number of the field's type", found));
            }
        }
    }
    Ok(points)
}

#[cfg(test)]
mod tests;
