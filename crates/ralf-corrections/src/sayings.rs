//! Who said what of detections, and when.

use crate::causes;
use crate::model::ScanVersion;
use crate::read::find_scan;
use rusqlite::{Connection, Row};
use std::collections::{BTreeMap, BTreeSet};

/// What somebody said once of some of the detections that were asked about.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Saying {
    /// Who, by name.
    pub author: String,
    /// When, ISO 8601 in UTC.
    pub at: String,
    /// The stroke's tool; `reviewed` or `unreviewed` of a mark of a scan.
    pub tool: String,
    /// The label; `None` took corrections away, or is a mark's.
    pub label: Option<u16>,
    /// Why they are artifacts, where the stroke said it.
    pub cause: Option<String>,
    /// Of how many of these detections.
    pub detections: u64,
    /// Whether it holds; what doesn't was taken back.
    pub holds: bool,
}

/// Everything that was said of these detections of these scans, the last first; each stroke once.
pub(crate) fn sayings(
    on: &Connection,
    asked: &[(ScanVersion, BTreeSet<u32>)],
) -> rusqlite::Result<Vec<Saying>> {
    let told = Told::of(on)?;
    let mut found: BTreeMap<i64, Saying> = BTreeMap::new();
    for (version, points) in asked {
        let Some(scan) = find_scan(on, version)? else { continue };
        for (stroke, saying, point) in told.of_detections(on, scan.id)? {
            if points.contains(&point) {
                found.entry(stroke).or_insert(saying).detections += 1;
            }
        }
        for (stroke, saying) in told.of_marks(on, scan.id)? {
            found.entry(stroke).or_insert(saying).detections += points.len() as u64;
        }
    }
    Ok(found.into_values().rev().collect())
}

/// What a stroke is told by.
const TOLD: &str = "stroke.id, name, at, tool, label, applied IS NOT NULL";
/// Where that lies.
const FROM: &str = "JOIN stroke ON stroke.id = said.stroke JOIN event ON event.id = stroke.made
    JOIN author ON author.id = stroke.author";

/// How strokes are asked for.
struct Told {
    columns: String,
    from: String,
}

impl Told {
    /// A store of a program that knew no causes, open for reading alone, has no table of them.
    fn of(on: &Connection) -> rusqlite::Result<Self> {
        let (cause, join) = match causes::any(on)? {
            true => ("cause", " LEFT JOIN stroke_cause ON stroke_cause.stroke = stroke.id"),
            false => ("NULL", ""),
        };
        Ok(Self { columns: format!("{TOLD}, {cause}"), from: format!("{FROM}{join} WHERE said.scan = ?") })
    }

    fn of_detections(&self, on: &Connection, scan: i64) -> rusqlite::Result<Vec<(i64, Saying, u32)>> {
        let Self { columns, from } = self;
        on.prepare_cached(&format!("SELECT {columns}, point FROM change AS said {from}"))?
            .query_map([scan], |row| Ok((row.get(0)?, saying(row)?, row.get(7)?)))?
            .collect()
    }

    fn of_marks(&self, on: &Connection, scan: i64) -> rusqlite::Result<Vec<(i64, Saying)>> {
        let Self { columns, from } = self;
        on.prepare_cached(&format!("SELECT {columns} FROM mark_change AS said {from}"))?
            .query_map([scan], |row| Ok((row.get(0)?, saying(row)?)))?
            .collect()
    }
}

fn saying(row: &Row) -> rusqlite::Result<Saying> {
    Ok(Saying {
        author: row.get(1)?,
        at: row.get(2)?,
        tool: row.get(3)?,
        label: row.get(4)?,
        cause: row.get(6)?,
        detections: 0,
        holds: row.get(5)?,
    })
}
