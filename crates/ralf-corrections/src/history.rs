//! What an author can undo and redo.

use crate::met::meets_any;
use crate::outcome::{History, Step};
use rusqlite::{Connection, OptionalExtension, params};
use std::collections::{BTreeSet, HashMap, HashSet, VecDeque};

/// A stroke, and the event that set it or took it back last.
#[derive(Clone, Copy)]
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
        let mut left = Left::new(self.strokes(
            on,
            "SELECT id, applied, step FROM stroke WHERE sequence = ? AND author = ? AND applied IS NOT NULL
             ORDER BY applied DESC, id DESC",
        )?);
        let mut steps = Vec::new();
        while steps.len() < wanted
            && let Some(step) = left.next(on)?
        {
            steps.extend(self.there(on, step)?);
        }
        Ok(steps)
    }

    /// So many steps that can be redone, the one that was taken back last first.
    fn redoable(self, on: &Connection, wanted: usize) -> rusqlite::Result<Vec<Vec<Placed>>> {
        let strokes = self.strokes(
            on,
            "SELECT id, undone, NULL FROM stroke WHERE sequence = ? AND author = ? AND undone IS NOT NULL
             ORDER BY undone DESC, id",
        )?;
        let mut steps = Vec::new();
        for step in strokes.chunk_by(|(a, _), (b, _)| a.moved == b.moved) {
            if steps.len() == wanted {
                break;
            }
            steps.extend(self.there(on, step.iter().map(|(stroke, _)| *stroke).collect())?);
        }
        Ok(steps)
    }

    /// The strokes that a query finds, each with the name of its step.
    fn strokes(self, on: &Connection, query: &str) -> rusqlite::Result<Vec<Named>> {
        on.prepare_cached(query)?
            .query_map(params![self.sequence, self.author], |row| {
                Ok((Placed { id: row.get(0)?, moved: row.get(1)? }, row.get(2)?))
            })?
            .collect()
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
}

/// A stroke with the name of its step; one without a name is a step by itself.
type Named = (Placed, Option<String>);

/// An author's strokes that no step was made of yet, the last one first.
struct Left {
    strokes: VecDeque<Named>,
    /// How many of each step there are.
    of_step: HashMap<String, usize>,
}

impl Left {
    fn new(strokes: Vec<Named>) -> Self {
        let mut of_step = HashMap::new();
        for step in strokes.iter().filter_map(|(_, step)| step.as_ref()) {
            *of_step.entry(step.clone()).or_default() += 1;
        }
        Self { strokes: strokes.into(), of_step }
    }

    /// The step of the last stroke. What another window did between its strokes stays; those before that it was done
    /// upon are a step of their own.
    fn next(&mut self, on: &Connection) -> rusqlite::Result<Option<Vec<Placed>>> {
        let Some((last, name)) = self.strokes.pop_front() else { return Ok(None) };
        let mut step = vec![last];
        let Some(name) = name else { return Ok(Some(step)) };
        let (mut between, mut met, all) = (Vec::new(), HashSet::new(), self.of_step[&name]);
        while step.len() < all {
            let Some(before) = self.strokes.pop_front() else { break };
            if before.1.as_ref() != Some(&name) {
                met.insert(before.0.id);
                between.push(before);
                continue;
            }
            if meets_any(on, before.0.id, &met)? {
                self.strokes.push_front(before);
                break;
            }
            step.push(before.0);
        }
        self.of_step.insert(name, all - step.len());
        between.into_iter().rev().for_each(|stroke| self.strokes.push_front(stroke));
        Ok(Some(step))
    }
}

/// Both ends of an author's history in a sequence, and how far it reaches.
pub(crate) fn history(on: &Connection, steps: Steps) -> rusqlite::Result<History> {
    let (undo, redo) = (steps.undoable(on, usize::MAX)?, steps.redoable(on, usize::MAX)?);
    let (undo_depth, redo_depth) = (undo.len() as u64, redo.len() as u64);
    let first = |steps: &[Vec<Placed>]| step(on, steps.first().map_or(&[], Vec::as_slice));
    Ok(History { undo: first(&undo)?, redo: first(&redo)?, undo_depth, redo_depth })
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
