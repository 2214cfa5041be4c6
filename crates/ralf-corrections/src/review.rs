//! Marking a scan as reviewed.

use crate::answered::{Asked, Made};
use crate::conflict::{Attempt, Refusal, overtaken_base};
use crate::content::ScanContent;
use crate::error::StoreError;
use crate::history::NONE;
use crate::model::{Mark, ScanVersion, Who};
use crate::outcome::{Outcome, Review};
use crate::read::{mark_of, review};
use crate::store::Store;
use crate::write::{NewStroke, add_stroke, log, log_scan, scan_id, set_mark};
use rusqlite::{Connection, Transaction, params};

impl Store {
    /// Sets or takes away a scan's mark, which is a step that can be undone. A mark that is there keeps the
    /// labels that were accepted first, for these are what the author saw.
    ///
    /// # Errors
    /// More detections than can be counted; a file that was deleted or replaced; see [`StoreError`].
    pub fn mark(&mut self, mark: &Mark, who: &Who) -> Result<Outcome, StoreError> {
        let detections = u32::try_from(mark.machine.len()).map_err(|_| {
            let (place, expected) =
                (format!("scan {}", mark.key), format!("at most {} detections", u32::MAX));
            StoreError::request(place, expected, mark.machine.len().to_string())
        })?;
        let content = ScanContent { detections, hash: mark.content };
        let version = ScanVersion { key: mark.key.clone(), content };
        self.write(|on| set(on, &version, mark, who))
    }
}

fn set(on: &Transaction, version: &ScanVersion, mark: &Mark, who: &Who) -> rusqlite::Result<Attempt> {
    let kind = if mark.reviewed { "reviewed" } else { "unreviewed" };
    let asked = Asked { kind, sequence: &mark.key.sequence, who, gone: &NONE };
    if let Some(made) = asked.made_before(on)? {
        return asked.answer_again(on, made, &[(version.clone(), mark.base)]).map(Attempt::Done);
    }
    if asked.is_taken(on)? {
        return Ok(Attempt::Taken);
    }
    let scan = scan_id(on, version)?;
    if let Some(conflict) = overtaken_base(on, scan, mark.base)? {
        return Ok(Attempt::Refused(Refusal { conflict, scans: vec![version.clone()] }));
    }
    let before = review(on, scan)?;
    let made = if mark.reviewed || before.is_some() {
        write(on, scan, mark, before, &asked)?
    } else {
        Made { event: None, stroke: None, changed: 0 }
    };
    asked.answer(on, made, std::slice::from_ref(version)).map(Attempt::Done)
}

fn write(
    on: &Connection,
    scan: i64,
    mark: &Mark,
    before: Option<Review>,
    asked: &Asked,
) -> rusqlite::Result<Made> {
    let event = log(on, asked.kind, asked.sequence, asked.who)?;
    let new = NewStroke { event, sequence: asked.sequence, tool: asked.kind, group: None, label: None };
    let stroke = add_stroke(on, asked.who, &new)?;
    let known = mark_of(on, scan)?;
    let after = if mark.reviewed {
        let accepted = before.map_or_else(|| mark.machine.clone(), |before| before.accepted);
        Some(add_mark(on, event, &accepted)?)
    } else {
        None
    };
    on.prepare_cached("INSERT INTO mark_change (stroke, scan, before, after) VALUES (?, ?, ?, ?)")?
        .execute(params![stroke, scan, known, after])?;
    set_mark(on, scan, after)?;
    log_scan(on, event, scan, false)?;
    Ok(Made { event: Some(event), stroke: Some(stroke), changed: 1 })
}

fn add_mark(on: &Connection, event: i64, accepted: &[u16]) -> rusqlite::Result<i64> {
    let accepted: Vec<u8> = accepted.iter().copied().flat_map(u16::to_le_bytes).collect();
    on.prepare_cached("INSERT INTO mark (event, accepted) VALUES (?, ?)")?
        .execute(params![event, accepted])?;
    Ok(on.last_insert_rowid())
}
