//! Edits with a name: none is made twice, however often it is asked for.

use crate::history::{Gone, Steps, history};
use crate::model::{ScanVersion, Who};
use crate::outcome::{Edit, ScanState};
use crate::read::{scan_state, version_of};
use crate::write::know_author;
use rusqlite::{Connection, OptionalExtension, params};

/// What is done, and by whom.
#[derive(Clone, Copy)]
pub(crate) struct Asked<'a> {
    pub(crate) kind: &'static str,
    pub(crate) sequence: &'a str,
    pub(crate) who: &'a Who,
    /// Scans that hold something else now.
    pub(crate) gone: &'a Gone,
}

/// What was done.
#[derive(Clone, Copy)]
pub(crate) struct Made {
    /// `None` where nothing was to be done.
    pub(crate) event: Option<i64>,
    pub(crate) stroke: Option<i64>,
    pub(crate) changed: u64,
}

impl Asked<'_> {
    /// What came of the same edit when it was asked for before.
    pub(crate) fn made_before(&self, on: &Connection) -> rusqlite::Result<Option<Made>> {
        let Some(name) = &self.who.edit else { return Ok(None) };
        let same = "id = ? AND kind = ? AND sequence = ? AND author = ?";
        on.prepare_cached(&format!("SELECT event, stroke, changed FROM edit WHERE {same}"))?
            .query_row(params![name, self.kind, self.sequence, self.who.author], |row| {
                Ok(Made { event: row.get(0)?, stroke: row.get(1)?, changed: row.get(2)? })
            })
            .optional()
    }

    /// Whether its name is that of an edit of another kind, sequence or author: it can't be noted under it.
    pub(crate) fn is_taken(&self, on: &Connection) -> rusqlite::Result<bool> {
        on.prepare_cached("SELECT EXISTS (SELECT 1 FROM edit WHERE id = ?)")?
            .query_row([&self.who.edit], |row| row.get(0))
    }

    /// Notes what came of it, and answers. `scans` are those that were to be edited.
    pub(crate) fn answer(
        &self,
        on: &Connection,
        made: Made,
        scans: &[ScanVersion],
    ) -> rusqlite::Result<Edit> {
        if let Some(name) = &self.who.edit {
            know_author(on, self.who)?;
            on.prepare_cached(
                "INSERT INTO edit (id, kind, sequence, author, event, stroke, changed) VALUES (?, ?, ?, ?, ?, ?, ?)",
            )?
            .execute(params![name, self.kind, self.sequence, self.who.author, made.event, made.stroke, made.changed])?;
        }
        let scans = scans.iter().map(|version| scan_state(on, version)).collect::<Result<_, _>>()?;
        self.edit(on, made, scans)
    }

    /// Answers as the first time: with the revisions that the edit led to, so that a later edit of somebody
    /// else is still met. `scans` are those that were to be edited, with the revisions that the author saw.
    pub(crate) fn answer_again(
        &self,
        on: &Connection,
        made: Made,
        scans: &[(ScanVersion, u64)],
    ) -> rusqlite::Result<Edit> {
        let mut states = Vec::new();
        for (version, base) in scans {
            states.push(ScanState { revision: *base, ..scan_state(on, version)? });
        }
        for (scan, revision) in made.event.map_or(Ok(Vec::new()), |event| revisions(on, event))? {
            let version = version_of(on, scan)?;
            let state = ScanState { revision, ..scan_state(on, &version)? };
            match states.iter_mut().find(|known| known.key == state.key) {
                Some(known) => *known = state,
                None => states.push(state),
            }
        }
        states.sort_by(|a, b| a.key.cmp(&b.key));
        self.edit(on, made, states)
    }

    /// The author's steps.
    pub(crate) fn steps(&self) -> Steps<'_> {
        Steps { sequence: self.sequence, author: &self.who.author, gone: self.gone }
    }

    fn edit(&self, on: &Connection, made: Made, scans: Vec<ScanState>) -> rusqlite::Result<Edit> {
        let history = history(on, self.steps())?;
        Ok(Edit { stroke: made.stroke, changed: made.changed, scans, history })
    }
}

/// The scans that an event concerned, and the revisions that it led to.
fn revisions(on: &Connection, event: i64) -> rusqlite::Result<Vec<(i64, u64)>> {
    on.prepare_cached("SELECT scan, revision FROM event_scan WHERE event = ?")?
        .query_map([event], |row| Ok((row.get(0)?, row.get(1)?)))?
        .collect()
}
