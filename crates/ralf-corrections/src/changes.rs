//! News of a sequence, for other windows.

use rusqlite::{Connection, params};

/// News of a sequence.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Changes {
    /// To be asked from the next time.
    pub counter: i64,
    /// Each scan concerned once, by its last change, in the order of these.
    pub scans: Vec<Change>,
}

/// A scan of which another window said something.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Change {
    /// The radar's name.
    pub radar: String,
    /// The scan's number.
    pub scan: u32,
    /// The revision that it led to.
    pub revision: u64,
    /// Who did it, by name.
    pub author: String,
}

pub(crate) fn changes(
    on: &Connection,
    sequence: &str,
    since: i64,
    tab: Option<&str>,
) -> rusqlite::Result<Vec<Change>> {
    // Of the columns beside max() SQLite takes the row that has it.
    on.prepare_cached(
        "SELECT radar, scan.scan, event_scan.revision, name, max(event.id) AS last
         FROM event JOIN event_scan ON event_scan.event = event.id JOIN scan ON scan.id = event_scan.scan
         JOIN author ON author.id = event.author
         WHERE event.id > ?1 AND event.sequence = ?2 AND (?3 IS NULL OR tab IS NOT ?3)
         GROUP BY radar, scan.scan ORDER BY last, radar, scan.scan",
    )?
    .query_map(params![since, sequence, tab], |row| {
        Ok(Change { radar: row.get(0)?, scan: row.get(1)?, revision: row.get(2)?, author: row.get(3)? })
    })?
    .collect()
}
