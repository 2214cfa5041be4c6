//! Columns of numbers, as the page reads them without parsing: a header in JSON, then the columns,
//! little-endian, each at a multiple of 8 bytes.

use crate::columns::Meaning;
use serde_json::{Map, Value, json};

const ALIGNMENT: usize = 8;

/// A table that grows column by column.
pub(crate) struct Table {
    rows: usize,
    columns: Vec<Value>,
    bytes: Vec<u8>,
}

impl Table {
    /// A table of so many rows, without columns.
    pub(crate) fn new(rows: usize) -> Self {
        Self { rows, columns: Vec::new(), bytes: Vec::new() }
    }

    /// Adds a column of decimals; NaN is absent.
    pub(crate) fn f32(&mut self, name: &str, values: impl IntoIterator<Item = f32>) {
        self.column(name, "f32", values.into_iter().map(f32::to_le_bytes));
    }

    /// Says what the last column means.
    pub(crate) fn explain(&mut self, meaning: &Meaning) {
        if let Some(Value::Object(column)) = self.columns.last_mut() {
            column.insert("unit".to_owned(), json!(meaning.unit));
            column.insert("meaning".to_owned(), json!(meaning.text));
            column.insert("group".to_owned(), json!(meaning.group.name()));
        }
    }

    /// Adds a column of small numbers.
    pub(crate) fn u8(&mut self, name: &str, values: impl IntoIterator<Item = u8>) {
        self.column(name, "u8", values.into_iter().map(u8::to_le_bytes));
    }

    /// Adds a column of numbers.
    pub(crate) fn u16(&mut self, name: &str, values: impl IntoIterator<Item = u16>) {
        self.column(name, "u16", values.into_iter().map(u16::to_le_bytes));
    }

    /// Adds a column of larger numbers.
    pub(crate) fn u32(&mut self, name: &str, values: impl IntoIterator<Item = u32>) {
        self.column(name, "u32", values.into_iter().map(u32::to_le_bytes));
    }

    fn column<const N: usize>(&mut self, name: &str, kind: &str, values: impl Iterator<Item = [u8; N]>) {
        self.columns.push(json!({ "name": name, "type": kind, "offset": self.bytes.len() }));
        let begin = self.bytes.len();
        self.bytes.extend(values.take(self.rows).flatten());
        debug_assert_eq!(self.bytes.len() - begin, N * self.rows, "{name}");
        self.bytes.resize(self.bytes.len().next_multiple_of(ALIGNMENT), 0);
    }

    /// The whole response, with more keys in its header.
    pub(crate) fn finish(self, more: Map<String, Value>) -> Vec<u8> {
        let mut header = json!({ "rows": self.rows, "columns": self.columns });
        if let Value::Object(keys) = &mut header {
            keys.extend(more);
        }
        let mut header = header.to_string().into_bytes();
        let length_bytes = size_of::<u32>();
        let padded = (length_bytes + header.len()).next_multiple_of(ALIGNMENT) - length_bytes;
        header.resize(padded, b' ');
        let mut response = Vec::with_capacity(length_bytes + padded + self.bytes.len());
        response.extend_from_slice(&(padded as u32).to_le_bytes());
        response.extend_from_slice(&header);
        response.extend_from_slice(&self.bytes);
        response
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_begin_at_multiples_of_eight() {
        let mut table = Table::new(3);
        table.u8("cause", [1, 2, 3]);
        table.f32("x", [0.5, f32::NAN, -1.0]);
        table.u16("flags", [1, 256, 65535]);
        let more = json!({ "t_ns": "17" });
        let bytes = table.finish(more.as_object().unwrap().clone());
        let length = u32::from_le_bytes(bytes[..4].try_into().unwrap()) as usize;
        assert_eq!((4 + length) % 8, 0);
        let header: Value = serde_json::from_slice(&bytes[4..4 + length]).unwrap();
        assert_eq!((&header["rows"], &header["t_ns"]), (&json!(3), &json!("17")));
        let offsets: Vec<_> =
            header["columns"].as_array().unwrap().iter().map(|c| c["offset"].clone()).collect();
        assert_eq!(offsets, [json!(0), json!(8), json!(24)]);
        let columns = &bytes[4 + length..];
        assert_eq!(columns[..4], [1, 2, 3, 0]);
        assert_eq!(columns[8..12], 0.5f32.to_le_bytes());
        assert!(f32::from_le_bytes(columns[12..16].try_into().unwrap()).is_nan());
        assert_eq!(columns[24..30], [1, 0, 0, 1, 255, 255]);
        assert_eq!(columns.len(), 32);
    }
}
