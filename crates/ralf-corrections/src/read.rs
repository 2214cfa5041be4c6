//! What the tables say of scans.

use crate::causes::causes;
use crate::content::{ContentHash, ScanContent};
use crate::model::{ScanKey, ScanVersion};
use crate::outcome::{Review, ScanState};
use rusqlite::{Connection, OptionalExtension, Row, params};
use std::collections::BTreeSet;

/// One scan of which something was said, as it was then.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanSummary {
    /// Which scan.
    pub key: ScanKey,
    /// What it held.
    pub content: ScanContent,
    /// How many of its detections a person has labelled.
    pub corrected: u64,
    /// Who marked it as reviewed, by name, and when (ISO 8601 in UTC).
    pub reviewed: Option<(String, String)>,
}

/// A scan's row.
pub(crate) struct ScanRow {
    pub(crate) id: i64,
    pub(crate) content: ScanContent,
    pub(crate) revision: u64,
}

/// The row of a scan with this content, see [`ScanContent::find_in`].
pub(crate) fn find_scan(on: &Connection, version: &ScanVersion) -> rusqlite::Result<Option<ScanRow>> {
    let mut rows = rows(on, &version.key)?;
    let contents: Vec<ScanContent> = rows.iter().map(|row| row.content).collect();
    Ok(version.content.find_in(&contents).map(|at| rows.swap_remove(at)))
}

/// The rows of a scan: one for each content that it had.
fn rows(on: &Connection, key: &ScanKey) -> rusqlite::Result<Vec<ScanRow>> {
    on.prepare_cached(
        "SELECT id, content, detections, revision FROM scan
             WHERE sequence = ? AND radar = ? AND scan = ? ORDER BY id",
    )?
    .query_map(params![key.sequence, key.radar, key.scan], |row| {
        Ok(ScanRow { id: row.get(0)?, content: content(row, 1, 2)?, revision: row.get(3)? })
    })?
    .collect()
}

/// The scans of a sequence of which something was ever said, once for each content that they had, with their rows.
pub(crate) fn versions(on: &Connection, sequence: &str) -> rusqlite::Result<Vec<(i64, ScanVersion)>> {
    on.prepare_cached("SELECT id, radar, scan, content, detections FROM scan WHERE sequence = ? ORDER BY id")?
        .query_map([sequence], |row| {
            let key = ScanKey { sequence: sequence.to_owned(), radar: row.get(1)?, scan: row.get(2)? };
            Ok((row.get(0)?, ScanVersion { key, content: content(row, 3, 4)? }))
        })?
        .collect()
}

/// The rows of these.
pub(crate) fn ids(on: &Connection, sequence: &str, of: &[ScanVersion]) -> rusqlite::Result<BTreeSet<i64>> {
    if of.is_empty() {
        return Ok(BTreeSet::new());
    }
    let all = versions(on, sequence)?.into_iter();
    Ok(all.filter(|(_, version)| of.contains(version)).map(|(id, _)| id).collect())
}

/// All that a scan held when somebody said something of it.
pub(crate) fn contents(on: &Connection, key: &ScanKey) -> rusqlite::Result<Vec<ScanContent>> {
    Ok(rows(on, key)?.into_iter().map(|row| row.content).collect())
}

/// A hash, and a number of detections.
pub(crate) fn content(row: &Row, hash: usize, detections: usize) -> rusqlite::Result<ScanContent> {
    let bytes: Vec<u8> = row.get(hash)?;
    let hash = bytes.try_into().ok().map(ContentHash::new);
    Ok(ScanContent { detections: row.get(detections)?, hash })
}

/// Which scan a row is of.
pub(crate) fn version_of(on: &Connection, scan: i64) -> rusqlite::Result<ScanVersion> {
    on.prepare_cached("SELECT sequence, radar, scan, content, detections FROM scan WHERE id = ?")?.query_row(
        [scan],
        |row| {
            let key = ScanKey { sequence: row.get(0)?, radar: row.get(1)?, scan: row.get(2)? };
            Ok(ScanVersion { key, content: content(row, 3, 4)? })
        },
    )
}

/// What is said of a scan.
pub(crate) fn scan_state(on: &Connection, version: &ScanVersion) -> rusqlite::Result<ScanState> {
    let (key, content) = (version.key.clone(), version.content.hash);
    let Some(row) = find_scan(on, version)? else {
        let (corrections, causes) = (Vec::new(), Vec::new());
        return Ok(ScanState { key, content, revision: 0, corrections, causes, review: None });
    };
    let (corrections, causes, review) = (corrections(on, row.id)?, causes(on, row.id)?, review(on, row.id)?);
    Ok(ScanState { key, content: row.content.hash, revision: row.revision, corrections, causes, review })
}

/// The corrections of a scan, by detection.
pub(crate) fn corrections(on: &Connection, scan: i64) -> rusqlite::Result<Vec<(u32, u16)>> {
    on.prepare_cached("SELECT point, label FROM correction WHERE scan = ? ORDER BY point")?
        .query_map([scan], |row| Ok((row.get(0)?, row.get(1)?)))?
        .collect()
}

/// The correction of a detection.
pub(crate) fn correction(on: &Connection, scan: i64, point: u32) -> rusqlite::Result<Option<u16>> {
    on.prepare_cached("SELECT label FROM correction WHERE scan = ? AND point = ?")?
        .query_row(params![scan, point], |row| row.get(0))
        .optional()
}

/// The mark of a scan.
pub(crate) fn review(on: &Connection, scan: i64) -> rusqlite::Result<Option<Review>> {
    on.prepare_cached(
        "SELECT name, at, accepted FROM review JOIN mark ON mark.id = review.mark JOIN event ON event.id = mark.event
         JOIN author ON author.id = event.author WHERE review.scan = ?",
    )?
    .query_row([scan], |row| {
        let accepted: Vec<u8> = row.get(2)?;
        let accepted = accepted.as_chunks().0.iter().map(|bytes| u16::from_le_bytes(*bytes)).collect();
        Ok(Review { author: row.get(0)?, at: row.get(1)?, accepted })
    })
    .optional()
}

/// The number of the mark that a scan has.
pub(crate) fn mark_of(on: &Connection, scan: i64) -> rusqlite::Result<Option<i64>> {
    on.prepare_cached("SELECT mark FROM review WHERE scan = ?")?
        .query_row([scan], |row| row.get(0))
        .optional()
}

/// The scans of a sequence that have corrections or a mark, by radar and number.
pub(crate) fn summaries(on: &Connection, sequence: &str) -> rusqlite::Result<Vec<ScanSummary>> {
    on.prepare_cached(
        "SELECT radar, scan.scan, content, detections,
                (SELECT count(*) FROM correction WHERE correction.scan = scan.id) AS corrected, name, event.at
         FROM scan LEFT JOIN review ON review.scan = scan.id LEFT JOIN mark ON mark.id = review.mark
         LEFT JOIN event ON event.id = mark.event LEFT JOIN author ON author.id = event.author
         WHERE scan.sequence = ? AND (corrected > 0 OR event.id IS NOT NULL)
         ORDER BY radar, scan.scan, scan.id",
    )?
    .query_map([sequence], |row| {
        let key = ScanKey { sequence: sequence.to_owned(), radar: row.get(0)?, scan: row.get(1)? };
        let reviewed = row.get::<_, Option<String>>(5)?.zip(row.get(6)?);
        Ok(ScanSummary { key, content: content(row, 2, 3)?, corrected: row.get(4)?, reviewed })
    })?
    .collect()
}
