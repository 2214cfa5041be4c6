//! Writing a stroke.

use crate::changes::{log, log_scan};
use crate::conflict::{Attempt, Refusal, overtaken_base};
use crate::error::{StoreError, told};
use crate::history::history;
use crate::model::{Edit, Outcome, ScanEdit, ScanKey, Stroke, Who};
use crate::store::{Store, scan_id, scan_state};
use rusqlite::{Connection, OptionalExtension, Transaction, params};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// A stroke's part in a scan, in the store's terms.
struct Part {
    id: i64,
    /// Detections, with the correction before, where it differs from the stroke's label.
    changes: Vec<(u32, Option<u16>)>,
}

impl Store {
    /// Writes a stroke: when this returns, it is on disk. A stroke that changes nothing leaves no trace.
    ///
    /// # Errors
    /// A scan of another size than when it was first edited, or named twice; a detection that it doesn't have; see [`StoreError`].
    pub fn apply(&mut self, stroke: &Stroke, who: &Who) -> Result<Outcome, StoreError> {
        check(stroke)?;
        self.write(|on, file| apply(on, file, stroke, who))
    }
}

/// What can be told without the store.
fn check(stroke: &Stroke) -> Result<(), StoreError> {
    let mut seen = BTreeSet::new();
    for edit in &stroke.scans {
        let place = format!("{} scan {}", edit.radar, edit.scan);
        if !seen.insert((&edit.radar, edit.scan)) {
            return Err(StoreError::request(place, "each scan once", "this one twice"));
        }
        if let Some(point) = edit.points.iter().find(|point| **point >= edit.detections) {
            let expected = format!("detections below {}", edit.detections);
            return Err(StoreError::request(place, expected, point.to_string()));
        }
    }
    Ok(())
}

fn apply(on: &Transaction, file: &Path, stroke: &Stroke, who: &Who) -> Result<Attempt<Edit>, StoreError> {
    let key = |edit: &ScanEdit| ScanKey {
        sequence: stroke.sequence.clone(),
        radar: edit.radar.clone(),
        scan: edit.scan,
    };
    let keys: BTreeSet<ScanKey> = stroke.scans.iter().map(key).collect();
    let mut parts = Vec::with_capacity(stroke.scans.len());
    for edit in &stroke.scans {
        let id = scan_id(on, file, &key(edit), edit.detections)?;
        if let Some(conflict) = overtaken_base(on, id, edit.base).map_err(told(file))? {
            return Ok(Attempt::Refused(Refusal { conflict, keys }));
        }
        let changes = changes(on, id, stroke, edit).map_err(told(file))?;
        parts.push(Part { id, changes });
    }
    let write = || {
        let stroke_id = write(on, stroke, who, &parts)?;
        let changed = parts.iter().map(|part| part.changes.len() as u64).sum();
        let scans = keys.iter().map(|key| scan_state(on, key)).collect::<Result<_, _>>()?;
        let history = history(on, &stroke.sequence, &who.author)?;
        Ok(Attempt::Done(Edit { stroke: stroke_id, changed, scans, history }))
    };
    write().map_err(told(file))
}

/// The detections of a scan that the stroke gives another label.
fn changes(
    on: &Connection,
    scan: i64,
    stroke: &Stroke,
    edit: &ScanEdit,
) -> rusqlite::Result<Vec<(u32, Option<u16>)>> {
    let known: BTreeMap<u32, u16> = crate::store::corrections(on, scan)?.into_iter().collect();
    let points: BTreeSet<u32> = edit.points.iter().copied().collect();
    let with_before = points.into_iter().map(|point| (point, known.get(&point).copied()));
    let changed =
        with_before.filter(|(_, before)| *before != stroke.label && !(stroke.protect && before.is_some()));
    Ok(changed.collect())
}

/// Writes what is changed; `None` where nothing is.
fn write(on: &Connection, stroke: &Stroke, who: &Who, parts: &[Part]) -> rusqlite::Result<Option<i64>> {
    if parts.iter().all(|part| part.changes.is_empty()) {
        return Ok(None);
    }
    on.prepare_cached(
        "UPDATE stroke SET undone = NULL WHERE sequence = ? AND author = ? AND undone IS NOT NULL",
    )?
    .execute(params![stroke.sequence, who.author])?;
    let event = log(on, "stroke", &stroke.sequence, who)?;
    on.prepare_cached(
        "INSERT INTO stroke (made, sequence, author, tool, step, label, applied) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?1)",
    )?
    .execute(params![event, stroke.sequence, who.author, stroke.tool, stroke.group, stroke.label])?;
    let id = on.last_insert_rowid();
    let mut change =
        on.prepare_cached("INSERT INTO change (stroke, scan, point, before, after) VALUES (?, ?, ?, ?, ?)")?;
    for part in parts.iter().filter(|part| !part.changes.is_empty()) {
        for (point, before) in &part.changes {
            change.execute(params![id, part.id, point, before, stroke.label])?;
            correct(on, part.id, *point, stroke.label)?;
        }
        log_scan(on, event, part.id, true)?;
    }
    Ok(Some(id))
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

/// The correction of a detection.
pub(crate) fn correction(on: &Connection, scan: i64, point: u32) -> rusqlite::Result<Option<u16>> {
    on.prepare_cached("SELECT label FROM correction WHERE scan = ? AND point = ?")?
        .query_row(params![scan, point], |row| row.get(0))
        .optional()
}
