//! What an author can undo and redo.

use crate::outcome::{History, Step};
use rusqlite::{Connection, OptionalExtension, Row, params};
use std::collections::BTreeSet;

/// A stroke, and the event that set it or took it back last.
pub(crate) struct Placed {
    pub(crate) id: i64,
    pub(crate) moved: i64,
}

/// Scans whose content is another one now: their rows. Nobody sees what would be done to them.
pub(crate) type Gone = BTreeSet<i64>;

/// None of them.
pub(crate) static NONE: Gone = BTreeSet::new();

/// Whose steps, in which sequence, and what of them stays as it is.
#[derive(Clone, Copy)]
pub(crate) struct Steps<'a> {
    pub(crate) sequence: &'a str,
    pub(crate) author: &'a str,
    pub(crate) gone: &'a Gone,
}

impl Steps<'_> {
    /// The strokes of the last step, the last one first.
    pub(crate) fn to_undo(self, on: &Connection) -> rusqlite::Result<Vec<Placed>> {
        self.undoable(on, 1).map(|steps| steps.into_iter().next().unwrap_or_default())
    }

    /// The strokes of the step that the author took back last, the first one first.
    pub(crate) fn to_redo(self, on: &Connection) -> rusqlite::Result<Vec<Placed>> {
        self.redoable(on, 1).map(|steps| steps.into_iter().next().unwrap_or_default())
    }

    /// So many steps that can be undone, the last one first.
    fn undoable(self, on: &Connection, wanted: usize) -> rusqlite::Result<Vec<Vec<Placed>>> {
        self.steps(
            on,
            "SELECT id, applied, step FROM stroke WHERE sequence = ? AND author = ? AND applied IS NOT NULL
             ORDER BY applied DESC, id DESC",
            wanted,
        )
    }

    /// So many steps that can be redone, the one that was taken back last first.
    fn redoable(self, on: &Connection, wanted: usize) -> rusqlite::Result<Vec<Vec<Placed>>> {
        self.steps(
            on,
            "SELECT id, undone, CAST(undone AS TEXT) FROM stroke
             WHERE sequence = ? AND author = ? AND undone IS NOT NULL ORDER BY undone DESC, id",
            wanted,
        )
    }

    /// The steps that a query's strokes make up: those in a row that have the same name for it.
    fn steps(self, on: &Connection, query: &str, wanted: usize) -> rusqlite::Result<Vec<Vec<Placed>>> {
        let mut query = on.prepare_cached(query)?;
        let mut rows = query.query(params![self.sequence, self.author])?;
        let (mut steps, mut strokes, mut step) = (Vec::new(), Vec::new(), None);
        while let Some(row) = rows.next()? {
            let of: Option<String> = row.get(2)?;
            if !strokes.is_empty() && (of.is_none() || of != step) {
                steps.extend(self.there(on, std::mem::take(&mut strokes))?);
                if steps.len() == wanted {
                    return Ok(steps);
                }
            }
            strokes.push(placed(row)?);
            step = of;
        }
        if !strokes.is_empty() {
            steps.extend(self.there(on, strokes)?);
        }
        Ok(steps)
    }

    /// A step, unless it changed what isn't there now.
    fn there(self, on: &Connection, strokes: Vec<Placed>) -> rusqlite::Result<Option<Vec<Placed>>> {
        if self.gone.is_empty() {
            return Ok(Some(strokes));
        }
        let mut query = on.prepare_cached(
            "SELECT scan FROM change WHERE stroke = ?1 UNION SELECT scan FROM mark_change WHERE stroke = ?1",
        )?;
        for stroke in &strokes {
            let mut rows = query.query([stroke.id])?;
            while let Some(row) = rows.next()? {
                if self.gone.contains(&row.get(0)?) {
                    return Ok(None);
                }
            }
        }
        Ok(Some(strokes))
    }

    /// How many steps can be undone, and how many redone.
    fn depths(self, on: &Connection) -> rusqlite::Result<(u64, u64)> {
        if !self.gone.is_empty() {
            let (undo, redo) = (self.undoable(on, usize::MAX)?, self.redoable(on, usize::MAX)?);
            return Ok((undo.len() as u64, redo.len() as u64));
        }
        let of = [self.sequence, self.author];
        let undo = "SELECT count(*) FROM (SELECT step, lag(step) OVER (ORDER BY applied, id) AS before FROM stroke
             WHERE sequence = ? AND author = ? AND applied IS NOT NULL) WHERE step IS NULL OR step IS NOT before";
        let redo = "SELECT count(DISTINCT undone) FROM stroke WHERE sequence = ? AND author = ?";
        Ok((count(on, undo, of)?, count(on, redo, of)?))
    }
}

fn placed(row: &Row) -> rusqlite::Result<Placed> {
    Ok(Placed { id: row.get(0)?, moved: row.get(1)? })
}

/// Both ends of an author's history in a sequence, and how far it reaches.
pub(crate) fn history(on: &Connection, steps: Steps) -> rusqlite::Result<History> {
    let (undo_depth, redo_depth) = steps.depths(on)?;
    let (undo, redo) = (step(on, &steps.to_undo(on)?)?, step(on, &steps.to_redo(on)?)?);
    Ok(History { undo, redo, undo_depth, redo_depth })
}

fn count(on: &Connection, query: &str, of: [&str; 2]) -> rusqlite::Result<u64> {
    on.prepare_cached(query)?.query_row(of, |row| row.get(0))
}

/// What a step did; `None` of no strokes.
fn step(on: &Connection, strokes: &[Placed]) -> rusqlite::Result<Option<Step>> {
    let mut changed = 0;
    for stroke in strokes {
        changed += on
            .prepare_cached(
                "SELECT (SELECT count(*) FROM change WHERE stroke = ?1)
                      + (SELECT count(*) FROM mark_change WHERE stroke = ?1)",
            )?
            .query_row([stroke.id], |row| row.get::<_, u64>(0))?;
    }
    let Some(last) = strokes.iter().map(|stroke| stroke.id).max() else { return Ok(None) };
    on.prepare_cached("SELECT tool, label, at FROM stroke JOIN event ON event.id = made WHERE stroke.id = ?")?
        .query_row([last], |row| Ok(Step { tool: row.get(0)?, label: row.get(1)?, at: row.get(2)?, changed }))
        .optional()
}
