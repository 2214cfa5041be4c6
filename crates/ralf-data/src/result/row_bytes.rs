//! The table of one scan as bytes: what a run that is killed leaves for the next one.

use super::schema::{Kind, Schema};
use super::{Table, Values};
use crate::error::DataError;
use std::path::Path;
use std::sync::Arc;

const NO_CLASS: u32 = u32::MAX;

/// A table's bytes: how many rows, then column by column. `file` is where they go.
pub(crate) fn row_bytes(file: &Path, table: &Table) -> Result<Vec<u8>, DataError> {
    let mut bytes = (table.len() as u64).to_le_bytes().to_vec();
    for (column, values) in table.columns() {
        append(&mut bytes, values).ok_or_else(|| no_such_kind(file, &column.name))?;
    }
    Ok(bytes)
}

fn append(bytes: &mut Vec<u8>, values: &Values) -> Option<()> {
    match values {
        Values::U8(values) => bytes.extend_from_slice(values),
        Values::U16(values) => values.iter().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes())),
        Values::U32(values) => values.iter().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes())),
        Values::I64(values) => values.iter().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes())),
        Values::F32(values) => values.iter().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes())),
        Values::Class(values) => {
            let classes = values.iter().map(|class| class.map_or(NO_CLASS, u32::from));
            classes.for_each(|class| bytes.extend_from_slice(&class.to_le_bytes()));
        }
        Values::Text(values) => {
            for value in values {
                bytes.extend_from_slice(&(value.len() as u32).to_le_bytes());
                bytes.extend_from_slice(value.as_bytes());
            }
        }
        Values::Truth(_) => return None,
    }
    Some(())
}

/// The table with these columns that [`row_bytes`] gave. `file` is where the bytes are from.
pub(crate) fn table_of_rows(file: &Path, bytes: &[u8], schema: &Arc<Schema>) -> Result<Table, DataError> {
    let cut = || DataError::content(file, "rows", "those of one scan", "others, or some that are cut short");
    let (rows, mut rest) = bytes.split_first_chunk().ok_or_else(cut)?;
    let rows = usize::try_from(u64::from_le_bytes(*rows)).map_err(|_| cut())?;
    let mut values = Vec::with_capacity(schema.columns().len());
    for column in schema.columns() {
        if column.kind == Kind::Text {
            let (texts, more) = texts(rest, rows).ok_or_else(cut)?;
            rest = more;
            values.push(Values::Text(texts));
            continue;
        }
        let size = size(column.kind).ok_or_else(|| no_such_kind(file, &column.name))?;
        let (of_column, more) = rest.split_at_checked(rows.saturating_mul(size)).ok_or_else(cut)?;
        rest = more;
        values.push(values_of(column.kind, of_column).ok_or_else(|| no_such_kind(file, &column.name))?);
    }
    if rest.is_empty() { Table::new(schema.clone(), values) } else { Err(cut()) }
}

/// So many texts, each after its length, and the bytes behind them.
fn texts(mut bytes: &[u8], rows: usize) -> Option<(Vec<Arc<str>>, &[u8])> {
    let mut texts = Vec::new();
    for _ in 0..rows {
        let (length, rest) = bytes.split_first_chunk::<4>()?;
        let (text, rest) = rest.split_at_checked(u32::from_le_bytes(*length) as usize)?;
        texts.push(std::str::from_utf8(text).ok()?.into());
        bytes = rest;
    }
    Some((texts, bytes))
}

/// Bytes of a value.
fn size(kind: Kind) -> Option<usize> {
    match kind {
        Kind::U8 => Some(1),
        Kind::U16 => Some(2),
        Kind::U32 | Kind::F32 | Kind::Class => Some(4),
        Kind::I64 => Some(8),
        Kind::Text | Kind::Truth => None,
    }
}

fn values_of(kind: Kind, bytes: &[u8]) -> Option<Values> {
    fn each<const N: usize, T>(bytes: &[u8], of: impl Fn([u8; N]) -> T) -> Vec<T> {
        bytes.as_chunks::<N>().0.iter().map(|bytes| of(*bytes)).collect()
    }
    Some(match kind {
        Kind::U8 => Values::U8(bytes.to_vec()),
        Kind::U16 => Values::U16(each(bytes, u16::from_le_bytes)),
        Kind::U32 => Values::U32(each(bytes, u32::from_le_bytes)),
        Kind::F32 => Values::F32(each(bytes, f32::from_le_bytes)),
        Kind::I64 => Values::I64(each(bytes, i64::from_le_bytes)),
        Kind::Class => Values::Class(each(bytes, |bytes| u16::try_from(u32::from_le_bytes(bytes)).ok())),
        Kind::Text | Kind::Truth => return None,
    })
}

fn no_such_kind(file: &Path, column: &str) -> DataError {
    DataError::content(file, format!("column `{column}`"), "numbers", "values that are none")
}
