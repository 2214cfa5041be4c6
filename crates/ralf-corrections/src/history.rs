//! What an author can undo and redo.

use crate::outcome::{History, Step};
use rusqlite::{Connection, OptionalExtension, Row, params};

/// A stroke, and the event that set it or took it back last.
pub(crate) struct Placed {
    pub(crate) id: i64,
    pub(crate) moved: i64,
}

/// The strokes of the author's last step in a sequence, the last one first.
pub(crate) fn strokes_to_undo(
    on: &Connection,
    sequence: &str,
    author: &str,
) -> rusqlite::Result<Vec<Placed>> {
    let mut query = on.prepare_cached(
        "SELECT id, applied, step FROM stroke WHERE sequence = ? AND author = ? AND applied IS NOT NULL
         ORDER BY applied DESC, id DESC",
    )?;
    let mut rows = query.query(params![sequence, author])?;
    let (mut strokes, mut step) = (Vec::new(), None);
    while let Some(row) = rows.next()? {
        let of: Option<String> = row.get(2)?;
        if !strokes.is_empty() && (of.is_none() || of != step) {
            break;
        }
        strokes.push(placed(row)?);
        step = of;
    }
    Ok(strokes)
}

/// The strokes of the step that the author took back last in a sequence, the first one first.
pub(crate) fn strokes_to_redo(
    on: &Connection,
    sequence: &str,
    author: &str,
) -> rusqlite::Result<Vec<Placed>> {
    on.prepare_cached(
        "SELECT id, undone FROM stroke WHERE sequence = ?1 AND author = ?2 AND undone =
           (SELECT max(undone) FROM stroke WHERE sequence = ?1 AND author = ?2) ORDER BY id",
    )?
    .query_map(params![sequence, author], placed)?
    .collect()
}

fn placed(row: &Row) -> rusqlite::Result<Placed> {
    Ok(Placed { id: row.get(0)?, moved: row.get(1)? })
}

/// Both ends of an author's history in a sequence, and how far it reaches.
pub(crate) fn history(on: &Connection, sequence: &str, author: &str) -> rusqlite::Result<History> {
    Ok(History {
        undo: step(on, &strokes_to_undo(on, sequence, author)?)?,
        redo: step(on, &strokes_to_redo(on, sequence, author)?)?,
        undo_depth: count(
            on,
            "SELECT count(*) FROM (SELECT step, lag(step) OVER (ORDER BY applied, id) AS before FROM stroke
             WHERE sequence = ? AND author = ? AND applied IS NOT NULL) WHERE step IS NULL OR step IS NOT before",
            [sequence, author],
        )?,
        redo_depth: count(
            on,
            "SELECT count(DISTINCT undone) FROM stroke WHERE sequence = ? AND author = ?",
            [sequence, author],
        )?,
    })
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
