//! The small pieces of which every edit consists.

use crate::model::{ScanVersion, Who};
use crate::read::find_scan;
use rusqlite::{Connection, params};

/// A scan's row, made where it has none. One of a store of the first version is known by its content from now on.
pub(crate) fn scan_id(on: &Connection, version: &ScanVersion) -> rusqlite::Result<i64> {
    let (key, content) = (&version.key, version.content);
    let hash = content.hash.as_ref().map_or(&[][..], |hash| hash.as_bytes());
    if let Some(row) = find_scan(on, version)? {
        if row.content.hash.is_none() && content.hash.is_some() {
            on.prepare_cached("UPDATE scan SET content = ? WHERE id = ?")?.execute(params![hash, row.id])?;
        }
        return Ok(row.id);
    }
    on.prepare_cached(
        "INSERT INTO scan (sequence, radar, scan, content, detections) VALUES (?, ?, ?, ?, ?)",
    )?
    .execute(params![key.sequence, key.radar, key.scan, hash, content.detections])?;
    Ok(on.last_insert_rowid())
}

/// Notes that something is done, with the time.
pub(crate) fn log(on: &Connection, kind: &str, sequence: &str, who: &Who) -> rusqlite::Result<i64> {
    know_author(on, who)?;
    // A journal holds the pages that changed: so it says whose it is (alone.rs).
    on.prepare_cached("UPDATE store SET rowid = 3 - rowid")?.execute([])?;
    on.prepare_cached("INSERT INTO event (kind, sequence, author, tab) VALUES (?, ?, ?, ?)")?
        .execute(params![kind, sequence, who.author, who.tab])?;
    Ok(on.last_insert_rowid())
}

/// Notes what a person is called now, if it has said so or has no name yet.
pub(crate) fn know_author(on: &Connection, who: &Who) -> rusqlite::Result<()> {
    on.prepare_cached(
        "INSERT INTO author (id, name) VALUES (?1, ?2)
         ON CONFLICT (id) DO UPDATE SET name = ?2 WHERE name <> ?2 AND ?3",
    )?
    .execute(params![who.author, who.name, who.is_named])
    .map(drop)
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

/// What a new stroke is.
pub(crate) struct NewStroke<'a> {
    pub(crate) event: i64,
    pub(crate) sequence: &'a str,
    pub(crate) tool: &'a str,
    pub(crate) group: Option<&'a str>,
    pub(crate) label: Option<u16>,
}

/// Adds a stroke that holds, and ends what its author could redo in the sequence.
pub(crate) fn add_stroke(on: &Connection, who: &Who, new: &NewStroke) -> rusqlite::Result<i64> {
    on.prepare_cached(
        "UPDATE stroke SET undone = NULL WHERE sequence = ? AND author = ? AND undone IS NOT NULL",
    )?
    .execute(params![new.sequence, who.author])?;
    on.prepare_cached(
        "INSERT INTO stroke (made, sequence, author, tool, step, label, applied) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?1)",
    )?
    .execute(params![new.event, new.sequence, who.author, new.tool, new.group, new.label])?;
    Ok(on.last_insert_rowid())
}

/// Sets a correction, or takes it away.
pub(crate) fn correct(on: &Connection, scan: i64, point: u32, label: Option<u16>) -> rusqlite::Result<()> {
    match label {
        Some(label) => on
            .prepare_cached("INSERT OR REPLACE INTO correction (scan, point, label) VALUES (?, ?, ?)")?
            .execute(params![scan, point, label])?,
        None => on
            .prepare_cached("DELETE FROM correction WHERE scan = ? AND point = ?")?
            .execute(params![scan, point])?,
    };
    Ok(())
}

/// Sets a scan's mark, or takes it away.
pub(crate) fn set_mark(on: &Connection, scan: i64, mark: Option<i64>) -> rusqlite::Result<()> {
    match mark {
        Some(mark) => on
            .prepare_cached("INSERT OR REPLACE INTO review (scan, mark) VALUES (?, ?)")?
            .execute(params![scan, mark])?,
        None => on.prepare_cached("DELETE FROM review WHERE scan = ?")?.execute([scan])?,
    };
    Ok(())
}
