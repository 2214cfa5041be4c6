//! Whether what holds is what the strokes say. Pages don't tell what was written into them.

use crate::error::{StoreError, told};
use crate::tables::VERSION;
use rusqlite::{Connection, OptionalExtension, Row};
use std::path::Path;

/// The first row that names a row that isn't there: its table, and the other's.
const FIRST_LOST: &str = "SELECT \"table\", parent FROM pragma_foreign_key_check LIMIT 1";

/// The first stroke with a change to another label than its own, with both.
const FIRST_OTHER: &str = "
SELECT stroke.id, label, after FROM change JOIN stroke ON stroke.id = change.stroke WHERE after IS NOT label LIMIT 1";

/// The first detection whose correction is not the `after` of its last applied change, as scan, detection, and both
/// labels. Strokes of one step are applied by one event, in the order of their numbers.
const FIRST_UNLIKE: &str = "
WITH last AS (
  SELECT scan, point, after AS label, max(applied << 32 | stroke.id)
  FROM change JOIN stroke ON stroke.id = change.stroke WHERE applied IS NOT NULL GROUP BY scan, point
), unlike AS (
  SELECT scan, point, last.label AS said, correction.label AS found
  FROM last LEFT JOIN correction USING (scan, point) WHERE last.label IS NOT correction.label
  UNION ALL
  SELECT scan, point, NULL, label FROM correction
  WHERE NOT EXISTS (SELECT 1 FROM last WHERE last.scan = correction.scan AND last.point = correction.point)
)
SELECT sequence || '/' || radar || '/' || scan.scan, point, said, found FROM unlike JOIN scan ON scan.id = unlike.scan
LIMIT 1";

/// The first scan whose mark is not the `after` of its last applied change, nor, where none is applied, what was there
/// before the first one; with both. Marks of a store of the first version were no changes.
const FIRST_UNMARKED: &str = "
WITH last AS (
  SELECT scan, after AS mark, max(applied << 32 | stroke.id)
  FROM mark_change JOIN stroke ON stroke.id = mark_change.stroke WHERE applied IS NOT NULL GROUP BY scan
), first AS (
  SELECT scan, before AS mark, min(stroke) FROM mark_change GROUP BY scan
), said AS (
  SELECT scan, mark FROM last
  UNION ALL
  SELECT scan, mark FROM first WHERE scan NOT IN (SELECT scan FROM last)
), unlike AS (
  SELECT scan, said.mark AS said, review.mark AS found
  FROM said LEFT JOIN review USING (scan) WHERE said.mark IS NOT review.mark
  UNION ALL
  SELECT scan, NULL, mark FROM review
  WHERE scan NOT IN (SELECT scan FROM said) AND mark IN (SELECT after FROM mark_change)
)
SELECT sequence || '/' || radar || '/' || scan.scan, said, found FROM unlike JOIN scan ON scan.id = unlike.scan
LIMIT 1";

/// The first mark that no scan has, and that no step gave.
const FIRST_LEFT: &str = "
SELECT id FROM mark WHERE id NOT IN (SELECT mark FROM review)
  AND id NOT IN (SELECT after FROM mark_change WHERE after IS NOT NULL)
  AND id NOT IN (SELECT before FROM mark_change WHERE before IS NOT NULL) LIMIT 1";

/// Refuses a store in which rows are missing, or whose corrections and marks are not what the strokes that hold say:
/// something in it was damaged.
pub(crate) fn check_standing(on: &Connection, file: &Path, version: i32) -> Result<(), StoreError> {
    let found = |find: fn(&Connection) -> rusqlite::Result<Option<Unlike>>| {
        find(on).map_err(told(file))?.map_or(Ok(()), |Unlike { place, expected, found }| {
            Err(StoreError::content(file, place, expected, found))
        })
    };
    found(|on| first(on, FIRST_LOST, lost))?;
    found(|on| first(on, FIRST_UNLIKE, unlike))?;
    found(|on| first(on, FIRST_OTHER, other))?;
    if version == VERSION {
        found(|on| first(on, FIRST_UNMARKED, unmarked))?;
        found(|on| first(on, FIRST_LEFT, left))?;
    }
    Ok(())
}

/// What is not as it should be.
struct Unlike {
    place: String,
    expected: String,
    found: String,
}

fn first(
    on: &Connection,
    query: &str,
    told: fn(&Row) -> rusqlite::Result<Unlike>,
) -> rusqlite::Result<Option<Unlike>> {
    on.query_row(query, [], told).optional()
}

fn lost(row: &Row) -> rusqlite::Result<Unlike> {
    let (table, named): (String, String) = (row.get(0)?, row.get(1)?);
    Ok(Unlike {
        place: format!("table {table}"),
        expected: format!("that all rows of {named} are there that it names"),
        found: "one missing".into(),
    })
}

fn other(row: &Row) -> rusqlite::Result<Unlike> {
    Ok(Unlike {
        place: format!("stroke {}", row.get::<_, i64>(0)?),
        expected: format!("changes to its label ({})", number(row, 1)?),
        found: format!("one to {}", number(row, 2)?),
    })
}

fn unlike(row: &Row) -> rusqlite::Result<Unlike> {
    let (scan, point): (String, i64) = (row.get(0)?, row.get(1)?);
    Ok(Unlike {
        place: format!("scan {scan}, correction of detection {point}"),
        expected: format!("what the last stroke there says ({})", number(row, 2)?),
        found: number(row, 3)?,
    })
}

fn unmarked(row: &Row) -> rusqlite::Result<Unlike> {
    Ok(Unlike {
        place: format!("scan {}, mark of review", row.get::<_, String>(0)?),
        expected: format!("what the last step there says ({})", number(row, 1)?),
        found: number(row, 2)?,
    })
}

fn left(row: &Row) -> rusqlite::Result<Unlike> {
    Ok(Unlike {
        place: format!("mark of review {}", row.get::<_, i64>(0)?),
        expected: "a scan that has it, or a step that gave it".into(),
        found: "none".into(),
    })
}

fn number(row: &Row, column: usize) -> rusqlite::Result<String> {
    Ok(row.get::<_, Option<i64>>(column)?.map_or("none".into(), |number| number.to_string()))
}
