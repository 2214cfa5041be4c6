//! The log of all that was done, and what another window has to hear of it.

use crate::error::{StoreError, told};
use crate::model::Who;
use crate::store::Store;
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
    /// Who did it.
    pub author: String,
}

impl Store {
    /// What was done in a sequence after `since`, by other windows than `tab`.
    pub fn changes(&self, sequence: &str, since: i64, tab: Option<&str>) -> Result<Changes, StoreError> {
        let counter = self.counter()?;
        let scans = changes(self.connection(), sequence, since, tab).map_err(told(self.file()))?;
        Ok(Changes { counter, scans })
    }
}

fn changes(on: &Connection, sequence: &str, since: i64, tab: Option<&str>) -> rusqlite::Result<Vec<Change>> {
    // Of the columns beside max() SQLite takes the row that has it.
    on.prepare_cached(
        "SELECT radar, scan.scan, event_scan.revision, author, max(event.id) AS last
         FROM event JOIN event_scan ON event_scan.event = event.id JOIN scan ON scan.id = event_scan.scan
         WHERE event.id > ?1 AND event.sequence = ?2 AND (?3 IS NULL OR tab IS NOT ?3)
         GROUP BY scan.id ORDER BY last, radar, scan.scan",
    )?
    .query_map(params![since, sequence, tab], |row| {
        Ok(Change { radar: row.get(0)?, scan: row.get(1)?, revision: row.get(2)?, author: row.get(3)? })
    })?
    .collect()
}

/// Notes that something is done, with the time.
pub(crate) fn log(on: &Connection, kind: &str, sequence: &str, who: &Who) -> rusqlite::Result<i64> {
    on.prepare_cached("INSERT INTO event (kind, sequence, author, tab) VALUES (?, ?, ?, ?)")?
        .execute(params![kind, sequence, who.author, who.tab])?;
    Ok(on.last_insert_rowid())
}

/// Notes that it concerns a scan, and whether its corrections changed.
pub(crate) fn log_scan(on: &Connection, event: i64, scan: i64, changed: bool) -> rusqlite::Result<()> {
    on.prepare_cached("UPDATE scan SET revision = revision + ? WHERE id = ?")?
        .execute(params![i64::from(changed), scan])?;
    on.prepare_cached(
        "INSERT INTO event_scan (event, scan, revision) SELECT ?, id, revision FROM scan WHERE id = ?",
    )?
    .execute(params![event, scan])?;
    Ok(())
}
