//! Disagreements that were settled.

use rusqlite::Connection;
use std::collections::BTreeMap;

/// The tool of strokes that settle what two people, neither of whom saw the other's labels, said of a detection.
pub const SETTLE: &str = "settle";

/// By scan: the detections that were settled, and the correction that each had before the first time.
pub(crate) type Settled = BTreeMap<i64, BTreeMap<u32, Option<u16>>>;

/// Everything that was settled: strokes that did are few, changes of scans are many.
pub(crate) fn settled(on: &Connection) -> rusqlite::Result<Settled> {
    let mut query = on.prepare_cached(
        "SELECT scan, point, before FROM stroke CROSS JOIN change ON change.stroke = stroke.id
         WHERE tool = ? AND applied IS NOT NULL ORDER BY applied, stroke.id",
    )?;
    let rows = query.query_map([SETTLE], |row| Ok((row.get(0)?, row.get(1)?, row.get(2)?)))?;
    let mut settled = Settled::new();
    for row in rows {
        let (scan, point, before) = row?;
        settled.entry(scan).or_default().entry(point).or_insert(before);
    }
    Ok(settled)
}
