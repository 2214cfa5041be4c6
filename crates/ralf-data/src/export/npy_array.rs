//! One-dimensional NumPy arrays (`.npy`, NEP 1), little-endian.

use super::columns::Values;
use crate::npy;

/// The bytes of a file that holds these numbers.
pub(super) fn of_u32(values: &[u32]) -> Vec<u8> {
    array("<u4", values.len(), values.iter().flat_map(|value| value.to_le_bytes()))
}

/// The bytes of a file that holds a column. What is true becomes 1, what is false 0, and what nobody knows -1.
pub(super) fn of_column(values: &Values) -> Vec<u8> {
    match values {
        Values::F32(values) => {
            array("<f4", values.len(), values.iter().flat_map(|value| value.to_le_bytes()))
        }
        Values::U16(values) => {
            array("<u2", values.len(), values.iter().flat_map(|value| value.to_le_bytes()))
        }
        Values::U32(values) => of_u32(values),
        Values::I64(values) => {
            array("<i8", values.len(), values.iter().flat_map(|value| value.to_le_bytes()))
        }
        Values::Truth(values) => {
            let number = |truth: &Option<bool>| truth.map_or(-1, i8::from).cast_unsigned();
            array("|i1", values.len(), values.iter().map(number))
        }
    }
}

fn array(descr: &str, rows: usize, values: impl Iterator<Item = u8>) -> Vec<u8> {
    npy::header(descr, &format!("{rows},")).into_iter().chain(values).collect()
}
