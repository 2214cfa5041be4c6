//! Values of columns as little-endian bytes.

use crate::result::{Kind, Values};

/// Bytes of a value; none of texts, which no cloud or array has.
pub(super) fn size(kind: Kind) -> usize {
    match kind {
        Kind::Text => 0,
        Kind::U8 | Kind::Truth => 1,
        Kind::U16 | Kind::Class => 2,
        Kind::F32 | Kind::U32 => 4,
        Kind::I64 => 8,
    }
}

/// Adds the bytes of a value: of what is true 1, of what is false 0, of what nobody knows -1; of no class 0.
pub(super) fn append(values: &Values, row: usize, bytes: &mut Vec<u8>) {
    match values {
        Values::Text(_) => {}
        Values::U8(values) => bytes.push(values[row]),
        Values::U16(values) => bytes.extend(values[row].to_le_bytes()),
        Values::U32(values) => bytes.extend(values[row].to_le_bytes()),
        Values::I64(values) => bytes.extend(values[row].to_le_bytes()),
        Values::F32(values) => bytes.extend(values[row].to_le_bytes()),
        Values::Class(values) => bytes.extend(values[row].unwrap_or_default().to_le_bytes()),
        Values::Truth(values) => bytes.extend(values[row].map_or(-1, i8::from).to_le_bytes()),
    }
}
