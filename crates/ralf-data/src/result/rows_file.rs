//! The table of one scan in a file of its own: what a run that is killed leaves for the next one.

use super::{Columns, ScanTable};
use crate::disk::files::{read, write_whole};
use crate::error::DataError;
use std::path::Path;

const MAGIC: &[u8; 8] = b"RALFrow1";
/// Magic, time, rows.
const HEADER: usize = 24;
const NO_CLASS: u32 = u32::MAX;

/// Writes a table, whole or not at all.
pub(crate) fn write_rows(file: &Path, table: &ScanTable) -> Result<(), DataError> {
    let mut bytes = Vec::with_capacity(HEADER + table.len() * (4 * table.decimals.len() + 7));
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&table.t_ns.to_le_bytes());
    bytes.extend_from_slice(&(table.len() as u64).to_le_bytes());
    for column in &table.decimals {
        column.iter().for_each(|value| bytes.extend_from_slice(&value.to_le_bytes()));
    }
    bytes.extend_from_slice(&table.label);
    table.flags.iter().for_each(|flags| bytes.extend_from_slice(&flags.to_le_bytes()));
    let classes = table.semantic.iter().map(|class| class.map_or(NO_CLASS, u32::from));
    classes.for_each(|class| bytes.extend_from_slice(&class.to_le_bytes()));
    write_whole(file, &bytes)
}

/// Reads what [`write_rows`] wrote for a sequence with these columns.
pub(crate) fn read_rows(file: &Path, columns: &Columns) -> Result<ScanTable, DataError> {
    let bytes = read(file)?;
    let mut rest = bytes.as_slice();
    let cut = || DataError::content(file, "end", "the rows of one scan", "another file, or one cut short");
    let mut take = |n: usize| {
        let (head, tail) = rest.split_at_checked(n).ok_or_else(cut)?;
        rest = tail;
        Ok::<&[u8], DataError>(head)
    };
    if take(MAGIC.len())? != MAGIC {
        return Err(cut());
    }
    let t_ns = i64::from_le_bytes(take(8)?.try_into().map_err(|_| cut())?);
    let rows = u64::from_le_bytes(take(8)?.try_into().map_err(|_| cut())?) as usize;
    let mut decimals = Vec::with_capacity(columns.count());
    for _ in 0..columns.count() {
        decimals.push(
            take(rows.saturating_mul(4))?.as_chunks().0.iter().map(|b| f32::from_le_bytes(*b)).collect(),
        );
    }
    let label = take(rows)?.to_vec();
    let flags = take(rows.saturating_mul(2))?.as_chunks().0.iter().map(|b| u16::from_le_bytes(*b)).collect();
    let classes = take(rows.saturating_mul(4))?.as_chunks().0.iter().map(|b| u32::from_le_bytes(*b));
    let semantic = classes.map(|class| u16::try_from(class).ok()).collect();
    if rest.is_empty() { Ok(ScanTable { t_ns, decimals, label, flags, semantic }) } else { Err(cut()) }
}
