//! One-dimensional NumPy arrays (`.npy`, NEP 1), little-endian.

use super::columns::Values;
use crate::disk::npy;

/// The bytes of a file that holds a column. What is true becomes 1, what is false 0, and what nobody knows -1.
pub(super) fn of_column(values: &Values) -> Vec<u8> {
    let descr = match values {
        Values::F32(_) => "<f4",
        Values::U16(_) => "<u2",
        Values::U32(_) => "<u4",
        Values::I64(_) => "<i8",
        Values::Truth(_) => "|i1",
    };
    let mut bytes = npy::header(descr, &format!("{},", values.len()));
    (0..values.len()).for_each(|row| values.append_bytes(row, &mut bytes));
    bytes
}
