//! Strokes that are about the same.

use rusqlite::Connection;
use std::collections::HashSet;

/// The other strokes with a change to a detection that a stroke changed, or to a scan's mark that it changed.
pub(crate) const MET: &str = "
  SELECT scan, other.stroke FROM change AS own JOIN change AS other USING (scan, point)
  WHERE own.stroke = ?1 AND other.stroke <> own.stroke
  UNION ALL
  SELECT scan, other.stroke FROM mark_change AS own JOIN mark_change AS other USING (scan)
  WHERE own.stroke = ?1 AND other.stroke <> own.stroke";

/// Whether a stroke shares a detection, or the mark of a scan, with one of these.
pub(crate) fn meets_any(on: &Connection, stroke: i64, others: &HashSet<i64>) -> rusqlite::Result<bool> {
    if others.is_empty() {
        return Ok(false);
    }
    let mut met = on.prepare_cached(MET)?;
    let mut met = met.query([stroke])?;
    while let Some(row) = met.next()? {
        if others.contains(&row.get(1)?) {
            return Ok(true);
        }
    }
    Ok(false)
}
