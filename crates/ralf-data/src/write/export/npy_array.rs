//! One-dimensional NumPy arrays (`.npy`, NEP 1), little-endian.

use super::bytes;
use crate::disk::npy;
use crate::result::{Kind, Value, Values};
use std::sync::Arc;

/// The bytes of a file that holds a column; see [`bytes::append`].
pub(super) fn of_column(values: &Values) -> Vec<u8> {
    let descr = match values.kind() {
        Kind::Text => return of_texts(<Arc<str>>::of(values).unwrap_or_default()),
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

/// Texts of one width, that of the longest: four bytes a letter, filled up with zeros.
fn of_texts(texts: &[Arc<str>]) -> Vec<u8> {
    let width = texts.iter().map(|text| text.chars().count()).max().unwrap_or(0).max(1);
    let mut all = npy::header(&format!("<U{width}"), &format!("{},", texts.len()));
    for text in texts {
        let letters = text.chars().map(u32::from).chain(std::iter::repeat(0)).take(width);
        letters.for_each(|letter| all.extend(letter.to_le_bytes()));
    }
    all
}
