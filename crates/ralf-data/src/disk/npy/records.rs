//! Tables as NumPy stores them: one-dimensional structured arrays, whose values are read by the names of their fields.

use super::{split, until_comma, value};
use crate::disk::files;
use crate::disk::number::Number;
use crate::error::DataError;
use std::path::{Path, PathBuf};

/// An array of records.
pub(crate) struct Records {
    file: PathBuf,
    fields: Vec<Field>,
    record_bytes: usize,
    body: Vec<u8>,
}

/// A value of each record.
struct Field {
    name: String,
    /// Bytes of a record before it.
    offset: usize,
    number: Number,
}

impl Records {
    /// Reads a file: little-endian, in C order, with or without padding.
    pub(crate) fn read(file: &Path) -> Result<Self, DataError> {
        let bytes = files::read(file)?;
        let wrong = |key: &str, expected: &str, found: &str| DataError::content(file, key, expected, found);
        let (header, body) =
            split(&bytes).ok_or_else(|| wrong("byte 0", "a NumPy file with its header", "something else"))?;
        let descr = value(header, "descr").unwrap_or("nothing");
        let (fields, record_bytes) = fields(descr).map_err(|found| {
            wrong("descr", "a list of named, little-endian numbers, one per field", &found)
        })?;
        let order = value(header, "fortran_order").unwrap_or("nothing");
        if !order.starts_with("False") {
            return Err(wrong("fortran_order", "False (C order)", until_comma(order)));
        }
        let rows = value(header, "shape").and_then(rows);
        let rows = rows.ok_or_else(|| wrong("shape", "one dimension, (rows,)", header.trim()))?;
        if rows.checked_mul(record_bytes) != Some(body.len()) {
            let expected = format!("{rows} records of {record_bytes} bytes, as the header says");
            return Err(wrong("data", &expected, &format!("{} bytes", body.len())));
        }
        Ok(Self { file: file.to_owned(), fields, record_bytes, body: body.to_vec() })
    }

    /// All values of a field; the nearest float32 of what it doesn't hold exactly.
    pub(crate) fn column(&self, name: &str) -> Result<Vec<f32>, DataError> {
        let field = self.field(name)?;
        Ok(self.bytes(field).map(|bytes| field.number.value(bytes) as f32).collect())
    }

    /// The whole numbers of a field.
    pub(crate) fn integers(&self, name: &str) -> Result<Vec<i64>, DataError> {
        let field = self.field(name)?;
        let wrong = |row: usize, found: String| {
            let place = format!("record {row}, `{name}`");
            DataError::content(&self.file, place, "a whole number of at most 63 bits", found)
        };
        let number = |(row, bytes)| field.number.integer(bytes).map_err(|found| wrong(row, found));
        self.bytes(field).enumerate().map(number).collect()
    }

    fn field(&self, name: &str) -> Result<&Field, DataError> {
        self.fields.iter().find(|field| field.name == name).ok_or_else(|| {
            let found: Vec<_> = self.fields.iter().map(|field| field.name.as_str()).collect();
            DataError::content(&self.file, "descr", format!("a field `{name}`"), found.join(", "))
        })
    }

    fn bytes(&self, field: &Field) -> impl Iterator<Item = &[u8]> {
        let place = field.offset..field.offset + field.number.size();
        self.body.chunks_exact(self.record_bytes).map(move |record| &record[place.clone()])
    }
}

/// The fields of `[('x', '<f4'), ('', '|V3'), ...]` and the size of a record; the error is what can't be read.
fn fields(descr: &str) -> Result<(Vec<Field>, usize), String> {
    let inside = descr.strip_prefix('[').and_then(|rest| rest.split_once(']'));
    let (inside, _) = inside.ok_or_else(|| until_comma(descr).to_owned())?;
    let (mut fields, mut offset) = (Vec::new(), 0usize);
    for entry in inside.split('(').skip(1) {
        let quoted: Vec<&str> = entry.split('\'').collect();
        let [_, name, _, kind, _] = quoted[..] else { return Err(format!("({entry}")) };
        let refused = || format!("'{name}' of the type '{kind}'");
        let (size, number) = number(kind).ok_or_else(refused)?;
        if let Some(number) = number {
            fields.push(Field { name: name.to_owned(), offset, number });
        }
        offset = offset.checked_add(size).ok_or_else(refused)?;
    }
    if fields.is_empty() { Err("no field".to_owned()) } else { Ok((fields, offset)) }
}

/// The size of a type and what it holds; `None` of bytes that are padding.
fn number(kind: &str) -> Option<(usize, Option<Number>)> {
    let mut letters = kind.chars();
    let order = letters.next().filter(|order| ['<', '|'].contains(order))?;
    let letter = letters.next()?;
    let size: usize = letters.as_str().parse().ok()?;
    let number = match letter {
        'V' => return Some((size, None)),
        'f' => Number::float(size),
        'i' => Number::signed(size),
        'u' => Number::unsigned(size),
        _ => None,
    };
    // Only single bytes have no order.
    number.filter(|_| order == '<' || size == 1).map(|number| (size, Some(number)))
}

/// The length of a shape of one dimension.
fn rows(shape: &str) -> Option<usize> {
    let (inside, _) = shape.strip_prefix('(')?.split_once(')')?;
    inside.trim().strip_suffix(',')?.trim().parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disk::npy::MAGIC;

    fn read(descr: &str, shape: &str, body: &[u8]) -> Result<Records, String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        let header = format!("{{'descr': {descr}, 'fortran_order': False, 'shape': {shape}, }}\n");
        let length = u16::try_from(header.len()).unwrap().to_le_bytes();
        let bytes = [MAGIC, &[1, 0], &length, header.as_bytes(), body].concat();
        std::fs::write(file.path(), bytes).unwrap();
        Records::read(file.path()).map_err(|error| error.to_string())
    }

    /// As `np.save` writes `np.zeros(2, dtype)`, with padding as `align=True` makes it.
    const DESCR: &str = "[('x', '<f4'), ('validity', '|i1'), ('', '|V3'), ('t', '<i8')]";

    #[test]
    fn values_are_read_by_name() {
        let mut body = Vec::new();
        for (x, validity, t) in [(1.5f32, -1i8, i64::MIN), (-2.0, 1, 1_644_845_012_251_875_000)] {
            body.extend([&x.to_le_bytes()[..], &validity.to_le_bytes(), &[9; 3], &t.to_le_bytes()].concat());
        }
        let records = read(DESCR, "(2,)", &body).unwrap();
        assert_eq!(records.column("x").unwrap(), [1.5, -2.0]);
        assert_eq!(records.integers("validity").unwrap(), [-1, 1]);
        assert_eq!(records.integers("t").unwrap(), [i64::MIN, 1_644_845_012_251_875_000]);
        let error = records.column("y").unwrap_err().to_string();
        assert!(error.contains("descr: expected a field `y`, found x, validity, t"), "{error}");
        assert!(records.integers("x").unwrap_err().to_string().contains("record 0, `x`: expected a whole"));
        assert!(read(DESCR, "(0,)", &[]).unwrap().column("x").unwrap().is_empty());
    }

    #[test]
    fn other_arrays_are_refused() {
        for (descr, shape, words) in [
            (DESCR, "(3,)", "data: expected 3 records of 16 bytes, as the header says, found 32 bytes"),
            (DESCR, "(2, 1)", "shape: expected one dimension"),
            (DESCR, "(18446744073709551615,)", "data: expected"),
            ("'<f4'", "(8,)", "descr: expected a list of named"),
            ("[('x', '>f4')]", "(8,)", "found 'x' of the type '>f4'"),
            ("[('x', '|f4')]", "(8,)", "found 'x' of the type '|f4'"),
            ("[('x', '<f4', (3,))]", "(8,)", "descr: expected"),
            ("[('x', '<U4')]", "(8,)", "'<U4'"),
            ("[('', '|V4')]", "(8,)", "found no field"),
            ("[]", "(8,)", "found no field"),
        ] {
            let error = read(descr, shape, &[0; 32]).map(drop).unwrap_err();
            assert!(error.contains(words), "{error} lacks {words}");
        }
    }
}
