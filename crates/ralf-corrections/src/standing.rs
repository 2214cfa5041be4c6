//! Whether the corrections are what the strokes that hold say.

use crate::error::{StoreError, told};
use rusqlite::{Connection, OptionalExtension};
use std::path::Path;

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

/// Refuses a store whose corrections are not what the strokes that hold say: a label in it is damaged. Pages don't tell
/// what was written into them.
pub(crate) fn check_corrections(on: &Connection, file: &Path) -> Result<(), StoreError> {
    let unlike = on
        .query_row(FIRST_UNLIKE, [], |row| {
            let scan: String = row.get(0)?;
            Ok((scan, row.get::<_, i64>(1)?, row.get::<_, Option<i64>>(2)?, row.get::<_, Option<i64>>(3)?))
        })
        .optional()
        .map_err(told(file))?;
    let Some((scan, point, said, found)) = unlike else { return Ok(()) };
    let label = |label: Option<i64>| label.map_or("none".to_owned(), |label| label.to_string());
    Err(StoreError::content(
        file,
        format!("scan {scan}, correction of detection {point}"),
        format!("what the last stroke there says ({})", label(said)),
        label(found),
    ))
}
