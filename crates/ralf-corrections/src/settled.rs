//! Disagreements that were settled.

use rusqlite::{Connection, params};
use std::collections::BTreeMap;

/// The tool of strokes that settle what two people, neither of whom saw the other's labels, said of a detection.
pub const SETTLE: &str = "settle";

/// The detections of a scan that were settled, and the correction that each had before the first time.
pub(crate) fn settled(on: &Connection, scan: i64) -> rusqlite::Result<Vec<(u32, Option<u16>)>> {
    let mut query = on.prepare_cached(
        "SELECT point, before FROM change JOIN stroke ON stroke.id = change.stroke
         WHERE scan = ? AND tool = ? AND applied IS NOT NULL ORDER BY applied, stroke.id",
    )?;
    let rows = query.query_map(params![scan, SETTLE], |row| Ok((row.get(0)?, row.get(1)?)))?;
    let mut first = BTreeMap::new();
    for row in rows {
        let (point, before) = row?;
        first.entry(point).or_insert(before);
    }
    Ok(first.into_iter().collect())
}
