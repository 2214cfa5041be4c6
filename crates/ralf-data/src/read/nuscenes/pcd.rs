//! Radar scans: PCD v0.7, binary. Records are read by field name and offset, as the header declares them.

use crate::disk::files;
use crate::error::DataError;
use std::ops::Range;
use std::path::Path;

/// A scan's bytes with what its header says of them.
pub(super) struct Pcd<'a> {
    file: &'a Path,
    fields: Vec<Field>,
    record_bytes: usize,
    records: usize,
    /// The records; what follows them (nuScenes pads with zeros) is no part of the scan.
    body: Vec<u8>,
}

/// One value of a record.
struct Field {
    name: String,
    bytes: Range<usize>,
    number: Number,
}

/// Types whose values float32 holds exactly.
#[derive(Debug, Clone, Copy)]
enum Number {
    F32,
    I8,
    I16,
    U8,
    U16,
}

impl<'a> Pcd<'a> {
    /// Reads a file. Errors name the header's line or the byte at which the data ends.
    pub(super) fn read(file: &'a Path) -> Result<Self, DataError> {
        let mut bytes = files::read(file)?;
        let header = Header::parse(file, &bytes)?;
        let fields = header.fields()?;
        let record_bytes = fields.last().map_or(0, |field| field.bytes.end);
        let records = header.records()?;
        let end = records.checked_mul(record_bytes).and_then(|length| length.checked_add(header.length));
        let start = header.length;
        match end.filter(|end| *end <= bytes.len()) {
            Some(end) => bytes.truncate(end),
            None => {
                let expected = format!("{records} records of {record_bytes} bytes from byte {start} on");
                let place = format!("byte {}", bytes.len());
                return Err(DataError::content(file, place, expected, "the end of the file"));
            }
        }
        Ok(Self { file, fields, record_bytes, records, body: bytes.split_off(start) })
    }

    /// All values of a field, in the order of the records.
    pub(super) fn column(&self, name: &str) -> Result<Vec<f32>, DataError> {
        let field = self.fields.iter().find(|field| field.name == name).ok_or_else(|| {
            let found: Vec<_> = self.fields.iter().map(|field| field.name.as_str()).collect();
            DataError::content(self.file, "FIELDS", format!("a field `{name}`"), found.join(" "))
        })?;
        let value =
            |record| field.number.value(&self.body[record * self.record_bytes..][field.bytes.clone()]);
        Ok((0..self.records).map(value).collect())
    }
}

impl Number {
    fn parse(kind: &str, size: &str) -> Option<(Self, usize)> {
        Some(match (kind, size) {
            ("F", "4") => (Self::F32, 4),
            ("I", "1") => (Self::I8, 1),
            ("I", "2") => (Self::I16, 2),
            ("U", "1") => (Self::U8, 1),
            ("U", "2") => (Self::U16, 2),
            _ => return None,
        })
    }

    /// From as many little-endian bytes as the type has.
    fn value(self, bytes: &[u8]) -> f32 {
        let pair = || [bytes[0], bytes[1]];
        match self {
            Self::F32 => f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]),
            Self::I8 => f32::from(bytes[0].cast_signed()),
            Self::I16 => f32::from(i16::from_le_bytes(pair())),
            Self::U8 => f32::from(bytes[0]),
            Self::U16 => f32::from(u16::from_le_bytes(pair())),
        }
    }
}

/// The header's lines, as keys and words.
struct Header<'a> {
    file: &'a Path,
    entries: Vec<(String, Vec<String>)>,
    /// Bytes up to the first record.
    length: usize,
}

impl<'a> Header<'a> {
    fn parse(file: &'a Path, bytes: &[u8]) -> Result<Self, DataError> {
        let mut entries: Vec<(String, Vec<String>)> = Vec::new();
        let mut length = 0;
        for line in bytes.split_inclusive(|byte| *byte == b'\n') {
            let bad = |found| {
                DataError::content(file, format!("byte {length}"), "a PCD header up to `DATA binary`", found)
            };
            let text = std::str::from_utf8(line).map_err(|_| bad("other bytes"))?;
            length += line.len();
            let mut words = text.split_whitespace().map(str::to_owned);
            let Some(key) = words.next().filter(|key| !key.starts_with('#')) else { continue };
            let words: Vec<String> = words.collect();
            if key == "DATA" {
                if words != ["binary"] {
                    return Err(DataError::content(file, "DATA", "binary", words.join(" ")));
                }
                return Ok(Self { file, entries, length });
            }
            entries.push((key, words));
        }
        Err(DataError::content(
            file,
            format!("byte {length}"),
            "a PCD header up to `DATA binary`",
            "the end of the file",
        ))
    }

    fn words(&self, key: &str) -> Result<&[String], DataError> {
        let entry = self.entries.iter().find(|(found, _)| found == key);
        let missing = || DataError::content(self.file, "header", format!("a line `{key}`"), "none");
        entry.map(|(_, words)| words.as_slice()).ok_or_else(missing)
    }

    /// Names, types and places of a record's values.
    fn fields(&self) -> Result<Vec<Field>, DataError> {
        let [names, sizes] = [self.words("FIELDS")?, self.words("SIZE")?];
        let [kinds, counts] = [self.words("TYPE")?, self.words("COUNT")?];
        for (key, words) in [("SIZE", sizes), ("TYPE", kinds), ("COUNT", counts)] {
            if words.len() != names.len() {
                let expected = format!("{} entries, one per field", names.len());
                return Err(DataError::content(self.file, key, expected, words.len().to_string()));
            }
        }
        let mut fields = Vec::with_capacity(names.len());
        let mut offset = 0;
        for (((name, size), kind), count) in names.iter().zip(sizes).zip(kinds).zip(counts) {
            let number = Number::parse(kind, size).filter(|_| count == "1").ok_or_else(|| {
                DataError::content(
                    self.file,
                    format!("field `{name}`"),
                    "one value of type F 4, I 1, I 2, U 1 or U 2",
                    format!("{count} of type {kind} {size}"),
                )
            })?;
            fields.push(Field { name: name.clone(), bytes: offset..offset + number.1, number: number.0 });
            offset += number.1;
        }
        Ok(fields)
    }

    /// How many records the header announces.
    fn records(&self) -> Result<usize, DataError> {
        let number = |key| {
            let words = self.words(key)?;
            let value =
                words.first().filter(|_| words.len() == 1).and_then(|word| word.parse::<usize>().ok());
            value.ok_or_else(|| DataError::content(self.file, key, "a whole number", words.join(" ")))
        };
        let [width, height, points] = [number("WIDTH")?, number("HEIGHT")?, number("POINTS")?];
        if width.checked_mul(height) != Some(points) {
            let expected = format!("WIDTH x HEIGHT = {width} x {height}");
            return Err(DataError::content(self.file, "POINTS", expected, points.to_string()));
        }
        Ok(points)
    }
}
