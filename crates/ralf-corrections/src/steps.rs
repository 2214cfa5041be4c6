//! Undo and redo.

use crate::apply::{correct, correction};
use crate::changes::{log, log_scan};
use crate::conflict::{Attempt, Refusal, last_edit, overtaken};
use crate::error::{StoreError, told};
use crate::history::{Placed, history, strokes_to_redo, strokes_to_undo};
use crate::model::{Conflict, Edit, Outcome, ScanKey, Who};
use crate::store::{Store, scan_state};
use rusqlite::{Connection, Row, Transaction, params};
use std::collections::BTreeSet;

/// Which way a step goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Undo,
    Redo,
}

/// What a stroke did to one detection.
struct Change {
    /// The scan's place in the store.
    scan: i64,
    point: u32,
    before: Option<u16>,
    after: Option<u16>,
}

impl Store {
    /// Takes back the author's last step in a sequence. Refused as a conflict where another author's later stroke is on one
    /// of its detections.
    pub fn undo(&mut self, sequence: &str, who: &Who) -> Result<Outcome, StoreError> {
        self.step(Way::Undo, sequence, who)
    }

    /// Sets the step again that the author took back last. Refused as a conflict where one of its detections was changed
    /// since.
    pub fn redo(&mut self, sequence: &str, who: &Who) -> Result<Outcome, StoreError> {
        self.step(Way::Redo, sequence, who)
    }

    fn step(&mut self, way: Way, sequence: &str, who: &Who) -> Result<Outcome, StoreError> {
        self.write(|on, file| step(on, way, sequence, who).map_err(told(file)))
    }
}

fn step(on: &Transaction, way: Way, sequence: &str, who: &Who) -> rusqlite::Result<Attempt<Edit>> {
    let strokes = match way {
        Way::Undo => strokes_to_undo(on, sequence, &who.author)?,
        Way::Redo => strokes_to_redo(on, sequence, &who.author)?,
    };
    let Some(last) = strokes.iter().map(|stroke| stroke.id).max() else {
        let history = history(on, sequence, &who.author)?;
        return Ok(Attempt::Done(Edit { stroke: None, changed: 0, scans: Vec::new(), history }));
    };
    let changes = strokes.iter().map(|stroke| changes_of(on, stroke.id)).collect::<Result<Vec<_>, _>>()?;
    let scans: BTreeSet<i64> = changes.iter().flatten().map(|change| change.scan).collect();
    let keys = scans.iter().map(|scan| key(on, *scan)).collect::<Result<BTreeSet<_>, _>>()?;
    let event = log(on, if way == Way::Undo { "undo" } else { "redo" }, sequence, who)?;
    for (stroke, changes) in strokes.iter().zip(&changes) {
        if let Some(conflict) = move_stroke(on, way, (stroke, changes), (event, &who.author))? {
            return Ok(Attempt::Refused(Refusal { conflict, keys }));
        }
    }
    scans.iter().try_for_each(|scan| log_scan(on, event, *scan, true))?;
    let changed = changes.iter().map(|changes| changes.len() as u64).sum();
    let scans = keys.iter().map(|key| scan_state(on, key)).collect::<Result<_, _>>()?;
    Ok(Attempt::Done(Edit {
        stroke: Some(last),
        changed,
        scans,
        history: history(on, sequence, &who.author)?,
    }))
}

/// Takes a stroke back or sets it again, unless somebody else's edit is in the way.
fn move_stroke(
    on: &Connection,
    way: Way,
    (stroke, changes): (&Placed, &[Change]),
    (event, author): (i64, &str),
) -> rusqlite::Result<Option<Conflict>> {
    if let Some(conflict) = overtaken(on, stroke, author)? {
        return Ok(Some(conflict));
    }
    for change in changes {
        let (from, to) = match way {
            Way::Undo => (change.after, change.before),
            Way::Redo => (change.before, change.after),
        };
        // The stroke below this one may have been taken back since.
        if correction(on, change.scan, change.point)? != from {
            return last_edit(on, change.scan).map(Some);
        }
        correct(on, change.scan, change.point, to)?;
    }
    let moved = match way {
        Way::Undo => "UPDATE stroke SET applied = NULL, undone = ? WHERE id = ?",
        Way::Redo => "UPDATE stroke SET applied = ?, undone = NULL WHERE id = ?",
    };
    on.prepare_cached(moved)?.execute(params![event, stroke.id])?;
    Ok(None)
}

fn changes_of(on: &Connection, stroke: i64) -> rusqlite::Result<Vec<Change>> {
    let change = |row: &Row| {
        Ok(Change { scan: row.get(0)?, point: row.get(1)?, before: row.get(2)?, after: row.get(3)? })
    };
    on.prepare_cached("SELECT scan, point, before, after FROM change WHERE stroke = ? ORDER BY scan, point")?
        .query_map([stroke], change)?
        .collect()
}

fn key(on: &Connection, scan: i64) -> rusqlite::Result<ScanKey> {
    on.prepare_cached("SELECT sequence, radar, scan FROM scan WHERE id = ?")?
        .query_row([scan], |row| Ok(ScanKey { sequence: row.get(0)?, radar: row.get(1)?, scan: row.get(2)? }))
}
