//! Whose edit came first.

use crate::history::Placed;
use crate::met::MET;
use crate::model::ScanVersion;
use crate::outcome::{Conflict, Edit};
use crate::read::scan_state;
use rusqlite::{Connection, OptionalExtension, Row, params};
use std::cmp::Ordering;

/// What came of an attempt to write, before anything is committed.
pub(crate) enum Attempt {
    Done(Edit),
    Refused(Refusal),
    /// Its name is another edit's.
    Taken,
}

/// Nothing is to be written.
pub(crate) struct Refusal {
    /// Whose edit came first.
    pub(crate) conflict: Conflict,
    /// The scans that were to be edited.
    pub(crate) scans: Vec<ScanVersion>,
}

impl Refusal {
    /// The conflict with the scans as they are.
    pub(crate) fn told(self, on: &Connection) -> rusqlite::Result<Conflict> {
        let scans = self.scans.iter().map(|version| scan_state(on, version)).collect::<Result<_, _>>()?;
        Ok(Conflict { scans, ..self.conflict })
    }
}

/// What a conflict names: author, time, tool, radar, scan. A stroke has its tool; undo and redo are named as such.
const NAMED: &str =
    "name, event.at, coalesce((SELECT tool FROM stroke WHERE made = event.id), event.kind), radar, scan.scan";

/// What of a scan an edit is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum About {
    Corrections,
    Mark,
}

/// The last edit of a scan, unless its revision is the one that the author saw. Of a revision that it never had nobody
/// is named.
pub(crate) fn overtaken_base(on: &Connection, scan: i64, base: u64) -> rusqlite::Result<Option<Conflict>> {
    let revision: u64 =
        on.prepare_cached("SELECT revision FROM scan WHERE id = ?")?.query_row([scan], |row| row.get(0))?;
    match base.cmp(&revision) {
        Ordering::Equal => Ok(None),
        Ordering::Less => last_edit(on, scan, About::Corrections).map(Some),
        Ordering::Greater => nobodys(on, scan).map(Some),
    }
}

/// The last edit of a scan; of one that was never edited nobody's.
pub(crate) fn last_edit(on: &Connection, scan: i64, about: About) -> rusqlite::Result<Conflict> {
    let kinds = match about {
        About::Corrections => "'stroke', 'undo', 'redo'",
        About::Mark => "'reviewed', 'unreviewed', 'undo', 'redo'",
    };
    let last = format!(
        "SELECT {NAMED} FROM event_scan JOIN event ON event.id = event_scan.event JOIN scan ON scan.id = event_scan.scan
         JOIN author ON author.id = event.author
         WHERE event_scan.scan = ? AND kind IN ({kinds}) ORDER BY event.id DESC LIMIT 1"
    );
    let found = on.prepare_cached(&last)?.query_row([scan], conflict).optional()?;
    found.map_or_else(|| nobodys(on, scan), Ok)
}

/// A conflict with no edit.
fn nobodys(on: &Connection, scan: i64) -> rusqlite::Result<Conflict> {
    on.query_row("SELECT '', '', '', radar, scan FROM scan WHERE id = ?", [scan], conflict)
}

/// The last stroke that somebody else than `but` set on one of this stroke's detections, or on one of its marks, since
/// it was set or taken back itself. What is there may be what the stroke left all the same: nothing, twice. Where it is
/// set again, the author's own later ones are no conflict: they follow.
pub(crate) fn overtaken(
    on: &Connection,
    stroke: &Placed,
    but: Option<&str>,
) -> rusqlite::Result<Option<Conflict>> {
    let later = format!(
        "SELECT {NAMED} FROM ({MET}) AS met
         JOIN stroke ON stroke.id = met.stroke JOIN event ON event.id = stroke.applied
         JOIN scan ON scan.id = met.scan JOIN author ON author.id = event.author
         WHERE stroke.applied > ?2 AND stroke.author IS NOT ?3
         ORDER BY stroke.applied DESC, stroke.id DESC LIMIT 1"
    );
    on.prepare_cached(&later)?.query_row(params![stroke.id, stroke.moved, but], conflict).optional()
}

fn conflict(row: &Row) -> rusqlite::Result<Conflict> {
    Ok(Conflict {
        author: row.get(0)?,
        at: row.get(1)?,
        tool: row.get(2)?,
        radar: row.get(3)?,
        scan: row.get(4)?,
        scans: Vec::new(),
    })
}
