//! Undo and redo.

use crate::answered::{Asked, Made};
use crate::conflict::{About, Attempt, Refusal, last_edit, overtaken};
use crate::error::StoreError;
use crate::history::Placed;
use crate::model::{ScanVersion, Who};
use crate::outcome::{Conflict, Outcome};
use crate::read::{correction, ids, mark_of, version_of};
use crate::store::Store;
use crate::write::{correct, log, log_scan, set_mark};
use rusqlite::{Connection, Transaction, params};
use std::collections::BTreeMap;

/// Which way a step goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Way {
    Undo,
    Redo,
}

impl Way {
    fn name(self) -> &'static str {
        match self {
            Self::Undo => "undo",
            Self::Redo => "redo",
        }
    }

    /// From what to what a change goes.
    fn turn<T>(self, before: T, after: T) -> (T, T) {
        match self {
            Self::Undo => (after, before),
            Self::Redo => (before, after),
        }
    }
}

/// A stroke and what it did.
struct Done {
    stroke: Placed,
    corrections: Vec<CorrectionChange>,
    marks: Vec<MarkChange>,
}

/// What a stroke did to one detection.
struct CorrectionChange {
    scan: i64,
    point: u32,
    before: Option<u16>,
    after: Option<u16>,
}

/// What a stroke did to the mark of one scan.
struct MarkChange {
    scan: i64,
    before: Option<i64>,
    after: Option<i64>,
}

impl Store {
    /// Takes back the author's last step in a sequence, and nobody else's. Refused as a conflict where another
    /// author's later stroke is on one of its detections, or another mark in the place of its mark.
    ///
    /// # Errors
    /// A file that was deleted or replaced; see [`StoreError`].
    pub fn undo(&mut self, sequence: &str, who: &Who) -> Result<Outcome, StoreError> {
        self.undo_without(sequence, who, &[])
    }

    /// The same, but steps that changed any of these are passed over: scans that hold something else now, so that
    /// nobody would see what is done to what was said of them.
    ///
    /// # Errors
    /// Those of [`Self::undo`].
    pub fn undo_without(
        &mut self,
        sequence: &str,
        who: &Who,
        gone: &[ScanVersion],
    ) -> Result<Outcome, StoreError> {
        self.write(|on| step(on, Way::Undo, (sequence, gone), who))
    }

    /// Sets the step again that the author took back last. Refused as a conflict where one of its detections
    /// was changed since.
    ///
    /// # Errors
    /// A file that was deleted or replaced; see [`StoreError`].
    pub fn redo(&mut self, sequence: &str, who: &Who) -> Result<Outcome, StoreError> {
        self.redo_without(sequence, who, &[])
    }

    /// The same, but steps that changed any of these are passed over; see [`Self::undo_without`].
    ///
    /// # Errors
    /// Those of [`Self::redo`].
    pub fn redo_without(
        &mut self,
        sequence: &str,
        who: &Who,
        gone: &[ScanVersion],
    ) -> Result<Outcome, StoreError> {
        self.write(|on| step(on, Way::Redo, (sequence, gone), who))
    }
}

fn step(
    on: &Transaction,
    way: Way,
    (sequence, gone): (&str, &[ScanVersion]),
    who: &Who,
) -> rusqlite::Result<Attempt> {
    let gone = ids(on, sequence, gone)?;
    let asked = Asked { kind: way.name(), sequence, who, gone: &gone };
    if let Some(made) = asked.made_before(on)? {
        return asked.answer_again(on, made, &[]).map(Attempt::Done);
    }
    if asked.is_taken(on)? {
        return Ok(Attempt::Taken);
    }
    let strokes = match way {
        Way::Undo => asked.steps().to_undo(on)?,
        Way::Redo => asked.steps().to_redo(on)?,
    };
    let Some(last) = strokes.iter().map(|stroke| stroke.id).max() else {
        return asked.answer(on, Made { event: None, stroke: None, changed: 0 }, &[]).map(Attempt::Done);
    };
    let strokes = strokes.into_iter().map(|stroke| done(on, stroke)).collect::<Result<Vec<_>, _>>()?;
    let touched = touched(&strokes);
    let mut scans = touched.keys().map(|scan| version_of(on, *scan)).collect::<Result<Vec<_>, _>>()?;
    scans.sort_by(|a, b| a.key.cmp(&b.key));
    let event = log(on, way.name(), sequence, who)?;
    for stroke in &strokes {
        if let Some(conflict) = move_stroke(on, way, stroke, event, &who.author)? {
            return Ok(Attempt::Refused(Refusal { conflict, scans }));
        }
    }
    for (scan, corrected) in touched {
        log_scan(on, event, scan, corrected)?;
    }
    let changed =
        strokes.iter().map(|stroke| stroke.corrections.len() + stroke.marks.len()).sum::<usize>() as u64;
    asked.answer(on, Made { event: Some(event), stroke: Some(last), changed }, &scans).map(Attempt::Done)
}

/// The scans that strokes concern, and whether they changed corrections there.
fn touched(strokes: &[Done]) -> BTreeMap<i64, bool> {
    let mut touched = BTreeMap::new();
    for stroke in strokes {
        for mark in &stroke.marks {
            touched.entry(mark.scan).or_insert(false);
        }
        for change in &stroke.corrections {
            touched.insert(change.scan, true);
        }
    }
    touched
}

/// Takes a stroke back or sets it again, unless somebody else's edit is in the way.
fn move_stroke(
    on: &Connection,
    way: Way,
    done: &Done,
    event: i64,
    author: &str,
) -> rusqlite::Result<Option<Conflict>> {
    // Of the author's own steps a later one may have been passed over, and is still there.
    let but = if way == Way::Undo { None } else { Some(author) };
    if let Some(conflict) = overtaken(on, &done.stroke, but)? {
        return Ok(Some(conflict));
    }
    for change in &done.corrections {
        let (from, to) = way.turn(change.before, change.after);
        // The stroke below this one may have been taken back since.
        if correction(on, change.scan, change.point)? != from {
            return last_edit(on, change.scan, About::Corrections).map(Some);
        }
        correct(on, change.scan, change.point, to)?;
    }
    for change in &done.marks {
        let (from, to) = way.turn(change.before, change.after);
        if mark_of(on, change.scan)? != from {
            return last_edit(on, change.scan, About::Mark).map(Some);
        }
        set_mark(on, change.scan, to)?;
    }
    let moved = match way {
        Way::Undo => "UPDATE stroke SET applied = NULL, undone = ? WHERE id = ?",
        Way::Redo => "UPDATE stroke SET applied = ?, undone = NULL WHERE id = ?",
    };
    on.prepare_cached(moved)?.execute(params![event, done.stroke.id])?;
    Ok(None)
}

fn done(on: &Connection, stroke: Placed) -> rusqlite::Result<Done> {
    let corrections = on
        .prepare_cached(
            "SELECT scan, point, before, after FROM change WHERE stroke = ? ORDER BY scan, point",
        )?
        .query_map([stroke.id], |row| {
            Ok(CorrectionChange {
                scan: row.get(0)?,
                point: row.get(1)?,
                before: row.get(2)?,
                after: row.get(3)?,
            })
        })?
        .collect::<Result<_, _>>()?;
    let marks = on
        .prepare_cached("SELECT scan, before, after FROM mark_change WHERE stroke = ? ORDER BY scan")?
        .query_map([stroke.id], |row| {
            Ok(MarkChange { scan: row.get(0)?, before: row.get(1)?, after: row.get(2)? })
        })?
        .collect::<Result<_, _>>()?;
    Ok(Done { stroke, corrections, marks })
}
