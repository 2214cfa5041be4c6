//! Who has done how much, day by day.

use rusqlite::{Connection, params};

/// Edits this far apart are taken for one stretch of work, s.
pub const PAUSE_S: f64 = 300.0;

/// What one person did on one day.
#[derive(Debug, Clone, PartialEq)]
pub struct Workday {
    /// Who, by name.
    pub author: String,
    /// The day in UTC, ISO 8601.
    pub day: String,
    /// Strokes, marks, undos and redos.
    pub edits: u64,
    /// Detections that strokes of that day have labelled, as far as these hold and the detections still have a label
    /// of a person; each once.
    pub detections: u64,
    /// Scans that were marked as reviewed, as far as these marks were not taken back and the scans still have one; each
    /// once.
    pub scans: u64,
    /// The time between edits no more than [`PAUSE_S`] apart, s; that over midnight is the later day's. What came
    /// before the first one of a stretch nobody knows.
    pub worked_s: f64,
}

/// By person, and then by day.
pub(crate) fn workdays(on: &Connection) -> rusqlite::Result<Vec<Workday>> {
    // People are told apart by their names here: who works in two browsers is one of them.
    on.prepare_cached(
        "WITH
         done AS (SELECT event.id, name, date(at) AS day, julianday(at) AS days
                  FROM event JOIN author ON author.id = event.author),
         apart AS (SELECT name, day, 86400 * (days - lag(days) OVER (PARTITION BY name ORDER BY days, id)) AS s
                   FROM done),
         worked AS (SELECT name, day, count(*) AS edits, total(CASE WHEN s <= ?1 THEN s END) AS s
                    FROM apart GROUP BY name, day),
         held AS (SELECT stroke.id, name, day FROM stroke JOIN done ON done.id = stroke.made
                  WHERE applied IS NOT NULL),
         labelled AS (SELECT name, day, count(*) AS detections
                      FROM (SELECT DISTINCT name, day, scan, point FROM held JOIN change ON change.stroke = held.id
                            JOIN correction USING (scan, point) WHERE after IS NOT NULL) GROUP BY name, day),
         marked AS (SELECT name, day, count(*) AS scans
                    FROM (SELECT DISTINCT name, day, scan FROM held JOIN mark_change ON mark_change.stroke = held.id
                          JOIN review USING (scan) WHERE after IS NOT NULL) GROUP BY name, day)
         SELECT name, day, edits, coalesce(detections, 0), coalesce(scans, 0), worked.s
         FROM worked LEFT JOIN labelled USING (name, day) LEFT JOIN marked USING (name, day) ORDER BY name, day",
    )?
    .query_map(params![PAUSE_S], |row| {
        Ok(Workday {
            author: row.get(0)?,
            day: row.get(1)?,
            edits: row.get(2)?,
            detections: row.get(3)?,
            scans: row.get(4)?,
            worked_s: row.get(5)?,
        })
    })?
    .collect()
}
