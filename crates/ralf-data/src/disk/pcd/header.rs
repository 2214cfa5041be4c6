//! The lines before the points.

use crate::disk::number::Number;
use crate::error::DataError;
use std::path::Path;

/// One value of a record.
pub(super) struct Field {
    pub(super) name: String,
    /// Bytes of a record before it.
    pub(super) offset: usize,
    pub(super) number: Number,
}

/// How the points are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Data {
    Ascii,
    Binary,
    Compressed,
}

/// The header's lines, as keys and words.
pub(super) struct Header<'a> {
    file: &'a Path,
    entries: Vec<(String, Vec<String>)>,
    pub(super) data: Data,
    /// Bytes up to the first point.
    pub(super) length: usize,
}

impl<'a> Header<'a> {
    pub(super) fn parse(file: &'a Path, bytes: &[u8]) -> Result<Self, DataError> {
        const EXPECTED: &str = "a PCD header up to `DATA`";
        let mut entries: Vec<(String, Vec<String>)> = Vec::new();
        let mut length = 0;
        for line in bytes.split_inclusive(|byte| *byte == b'\n') {
            let bad = |found| DataError::content(file, format!("byte {length}"), EXPECTED, found);
            let text = std::str::from_utf8(line).map_err(|_| bad("other bytes"))?;
            length += line.len();
            let mut words = text.split_whitespace().map(str::to_owned);
            let Some(key) = words.next().filter(|key| !key.starts_with('#')) else { continue };
            let words: Vec<String> = words.collect();
            if key != "DATA" {
                entries.push((key, words));
                continue;
            }
            let data = match words.join(" ").as_str() {
                "ascii" => Data::Ascii,
                "binary" => Data::Binary,
                "binary_compressed" => Data::Compressed,
                other => {
                    let expected = "binary, binary_compressed or ascii";
                    return Err(DataError::content(file, "DATA", expected, other));
                }
            };
            return Ok(Self { file, entries, data, length });
        }
        Err(DataError::content(file, format!("byte {length}"), EXPECTED, "the end of the file"))
    }

    fn words(&self, key: &str) -> Result<&[String], DataError> {
        let entry = self.entries.iter().find(|(found, _)| found == key);
        let missing = || DataError::content(self.file, "header", format!("a line `{key}`"), "none");
        entry.map(|(_, words)| words.as_slice()).ok_or_else(missing)
    }

    /// Names, types and places of a record's values, and how many bytes it takes.
    pub(super) fn fields(&self) -> Result<(Vec<Field>, usize), DataError> {
        let [names, sizes] = [self.words("FIELDS")?, self.words("SIZE")?];
        let [kinds, counts] = [self.words("TYPE")?, self.words("COUNT")?];
        for (key, words) in [("SIZE", sizes), ("TYPE", kinds), ("COUNT", counts)] {
            if words.len() != names.len() {
                let expected = format!("{} entries, one per field", names.len());
                return Err(DataError::content(self.file, key, expected, words.len().to_string()));
            }
        }
        if names.is_empty() {
            return Err(DataError::content(self.file, "FIELDS", "at least one field", "none"));
        }
        let mut fields = Vec::with_capacity(names.len());
        let mut offset = 0;
        for (((name, size), kind), count) in names.iter().zip(sizes).zip(kinds).zip(counts) {
            let number = number(kind, size).filter(|_| count == "1").ok_or_else(|| {
                DataError::content(
                    self.file,
                    format!("field `{name}`"),
                    "one value of type F 4, F 8, or I or U of 1, 2, 4 or 8",
                    format!("{count} of type {kind} {size}"),
                )
            })?;
            fields.push(Field { name: name.clone(), offset, number });
            offset += number.size();
        }
        Ok((fields, offset))
    }

    /// How many records the header announces.
    pub(super) fn records(&self) -> Result<usize, DataError> {
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

/// A type by its letter and its size in bytes.
fn number(kind: &str, size: &str) -> Option<Number> {
    let size = size.parse().ok()?;
    match kind {
        "F" => Number::float(size),
        "I" => Number::signed(size),
        "U" => Number::unsigned(size),
        _ => None,
    }
}
