//! One-dimensional NumPy arrays (`.npy`, NEP 1), little-endian.

use super::bytes;
use crate::disk::npy;
use crate::result::{Kind, Values};

/// The bytes of a file that holds a column; see [`bytes::append`].
pub(super) fn of_column(values: &Values) -> Vec<u8> {
    let descr = match values.kind() {
        Kind::Text => "|V0",
        Kind::U8 => "|u1",
        Kind::U16 | Kind::Class => "<u2",
        Kind::U32 => "<u4",
        Kind::I64 => "<i8",
        Kind::F32 => "<f4",
        Kind::Truth => "|i1",
    };
    let mut all = npy::header(descr, &format!("{},", values.len()));
    (0..values.len()).for_each(|row| bytes::append(values, row, &mut all));
    all
}
