//! The open store: what can be asked of it.

use crate::conflict::Attempt;
use crate::error::{StoreError, told};
use crate::history::history;
use crate::model::{History, Outcome, Review, ScanKey, ScanState};
use crate::schema;
use rusqlite::{Connection, OptionalExtension, Row, Transaction, TransactionBehavior, params};
use std::path::{Path, PathBuf};

/// The corrections of one output folder. Several programs may have it open at once.
#[derive(Debug)]
pub struct Store {
    connection: Connection,
    file: PathBuf,
}

/// One scan of which something was said.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanSummary {
    /// Which scan.
    pub key: ScanKey,
    /// How many of its detections a person has labelled.
    pub corrected: u64,
    /// Who marked it as reviewed, and when (ISO 8601 in UTC).
    pub reviewed: Option<(String, String)>,
}

impl Store {
    /// Opens a store; makes it where there is no such file yet.
    ///
    /// # Errors
    /// A file that is no store, or one of another version; one that can't be written, or that is locked.
    pub fn open(file: &Path) -> Result<Self, StoreError> {
        Ok(Self { connection: schema::open(file)?, file: file.to_owned() })
    }

    /// Where the store lies.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// What is said of a scan; nothing of one that was never touched.
    pub fn scan(&self, key: &ScanKey) -> Result<ScanState, StoreError> {
        scan_state(&self.connection, key).map_err(told(&self.file))
    }

    /// The same of a scan that has so many detections.
    ///
    /// # Errors
    /// A scan that had another number of them when it was first edited; see [`StoreError`].
    pub fn scan_of_size(&self, key: &ScanKey, detections: usize) -> Result<ScanState, StoreError> {
        let known = self
            .connection
            .prepare_cached("SELECT detections FROM scan WHERE sequence = ? AND radar = ? AND scan = ?")
            .and_then(|mut query| {
                query.query_row(params![key.sequence, key.radar, key.scan], |row| row.get(0)).optional()
            });
        match known.map_err(told(&self.file))? {
            Some(known) if known != detections => Err(another_size(&self.file, key, known, detections)),
            _ => self.scan(key),
        }
    }

    /// What an author can undo and redo in a sequence.
    pub fn history(&self, sequence: &str, author: &str) -> Result<History, StoreError> {
        history(&self.connection, sequence, author).map_err(told(&self.file))
    }

    /// The scans of a sequence that have corrections or a mark, by radar and number.
    pub fn summaries(&self, sequence: &str) -> Result<Vec<ScanSummary>, StoreError> {
        summaries(&self.connection, sequence).map_err(told(&self.file))
    }

    /// The number of the last thing done, by anyone, in any sequence; 0 before the first.
    pub fn counter(&self) -> Result<i64, StoreError> {
        let last = "SELECT coalesce(max(id), 0) FROM event";
        self.connection.query_row(last, [], |row| row.get(0)).map_err(told(&self.file))
    }

    pub(crate) fn connection(&self) -> &Connection {
        &self.connection
    }

    /// Writes all of it, or nothing where it is refused.
    pub(crate) fn write<T>(
        &mut self,
        work: impl FnOnce(&Transaction, &Path) -> Result<Attempt<T>, StoreError>,
    ) -> Result<Outcome<T>, StoreError> {
        let failed = told(&self.file);
        let transaction =
            self.connection.transaction_with_behavior(TransactionBehavior::Immediate).map_err(&failed)?;
        match work(&transaction, &self.file)? {
            Attempt::Done(done) => transaction.commit().map(|()| Outcome::Done(done)).map_err(failed),
            Attempt::Refused(refusal) => {
                transaction.rollback().map_err(&failed)?;
                refusal.told(&self.connection).map(Outcome::Conflict).map_err(failed)
            }
        }
    }
}

/// A scan's place in the store, made where it has none. Refused is a scan of another size.
pub(crate) fn scan_id(
    on: &Connection,
    file: &Path,
    key: &ScanKey,
    detections: u32,
) -> Result<i64, StoreError> {
    let known = || {
        on.prepare_cached(
            "INSERT INTO scan (sequence, radar, scan, detections) VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING",
        )?
        .execute(params![key.sequence, key.radar, key.scan, detections])?;
        on.prepare_cached("SELECT id, detections FROM scan WHERE sequence = ? AND radar = ? AND scan = ?")?
            .query_row(params![key.sequence, key.radar, key.scan], |row| {
                Ok((row.get::<_, i64>(0)?, row.get::<_, u32>(1)?))
            })
    };
    let (id, expected) = known().map_err(told(file))?;
    if expected == detections {
        return Ok(id);
    }
    Err(another_size(file, key, expected as usize, detections as usize))
}

fn another_size(file: &Path, key: &ScanKey, known: usize, found: usize) -> StoreError {
    let expected = format!("{known} detections as when it was first edited");
    StoreError::content(file, format!("scan {key}"), expected, found.to_string())
}

/// What is said of a scan.
pub(crate) fn scan_state(on: &Connection, key: &ScanKey) -> rusqlite::Result<ScanState> {
    let scan = on
        .prepare_cached("SELECT id, revision FROM scan WHERE sequence = ? AND radar = ? AND scan = ?")?
        .query_row(params![key.sequence, key.radar, key.scan], |row| Ok((row.get(0)?, row.get(1)?)))
        .optional()?;
    let Some((id, revision)) = scan else {
        return Ok(ScanState { key: key.clone(), revision: 0, corrections: Vec::new(), review: None });
    };
    let (corrections, review) = (corrections(on, id)?, review(on, id)?);
    Ok(ScanState { key: key.clone(), revision, corrections, review })
}

/// The corrections of a scan, by detection.
pub(crate) fn corrections(on: &Connection, scan: i64) -> rusqlite::Result<Vec<(u32, u16)>> {
    on.prepare_cached("SELECT point, label FROM correction WHERE scan = ? ORDER BY point")?
        .query_map([scan], |row| Ok((row.get(0)?, row.get(1)?)))?
        .collect()
}

/// The mark of a scan.
pub(crate) fn review(on: &Connection, scan: i64) -> rusqlite::Result<Option<Review>> {
    let mark = |row: &Row| {
        let accepted: Vec<u8> = row.get(2)?;
        let accepted = accepted.as_chunks().0.iter().map(|bytes| u16::from_le_bytes(*bytes)).collect();
        Ok(Review { author: row.get(0)?, at: row.get(1)?, accepted })
    };
    on.prepare_cached(
        "SELECT author, at, accepted FROM review JOIN event ON event.id = review.event WHERE review.scan = ?",
    )?
    .query_row([scan], mark)
    .optional()
}

fn summaries(on: &Connection, sequence: &str) -> rusqlite::Result<Vec<ScanSummary>> {
    let summary = |row: &Row| {
        let key = ScanKey { sequence: sequence.to_owned(), radar: row.get(0)?, scan: row.get(1)? };
        let reviewed = row.get::<_, Option<String>>(3)?.zip(row.get(4)?);
        Ok(ScanSummary { key, corrected: row.get(2)?, reviewed })
    };
    on.prepare_cached(
        "SELECT radar, scan.scan, (SELECT count(*) FROM correction WHERE correction.scan = scan.id) AS corrected,
                event.author, event.at
         FROM scan LEFT JOIN review ON review.scan = scan.id LEFT JOIN event ON event.id = review.event
         WHERE scan.sequence = ? AND (corrected > 0 OR event.id IS NOT NULL)
         ORDER BY radar, scan.scan",
    )?
    .query_map([sequence], summary)?
    .collect()
}
