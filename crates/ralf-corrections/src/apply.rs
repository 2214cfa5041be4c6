//! Writing a stroke.

use crate::answered::{Asked, Made};
use crate::causes::{causes, say};
use crate::conflict::{Attempt, Refusal, overtaken_base};
use crate::error::StoreError;
use crate::history::NONE;
use crate::model::{ScanEdit, ScanVersion, Stroke, Who};
use crate::outcome::Outcome;
use crate::read::corrections;
use crate::store::Store;
use crate::write::{NewStroke, add_stroke, correct, log, log_scan, scan_id};
use rusqlite::{Connection, Transaction, params};
use std::collections::{BTreeMap, BTreeSet};

/// A stroke's part in a scan, in the store's terms.
struct Part {
    scan: i64,
    /// Detections, with the correction before.
    changes: Vec<(u32, Option<u16>)>,
}

impl Store {
    /// Writes a stroke: when this returns, it is on disk. A stroke that changes nothing leaves nothing to be undone.
    ///
    /// # Errors
    /// A scan named twice; a detection that it doesn't have; a file that was deleted or replaced; see [`StoreError`].
    pub fn apply(&mut self, stroke: &Stroke, who: &Who) -> Result<Outcome, StoreError> {
        check(stroke)?;
        self.write(|on| apply(on, stroke, who))
    }
}

/// What can be told without the store.
fn check(stroke: &Stroke) -> Result<(), StoreError> {
    let mut seen = BTreeSet::new();
    for edit in &stroke.scans {
        let place = format!("{} scan {}", edit.radar, edit.scan);
        if !seen.insert((&edit.radar, edit.scan)) {
            return Err(StoreError::request(place, "each scan once", "this one twice"));
        }
        if let Some(point) = edit.points.iter().find(|point| **point >= edit.detections) {
            let expected = format!("detections below {}", edit.detections);
            return Err(StoreError::request(place, expected, point.to_string()));
        }
    }
    Ok(())
}

fn apply(on: &Transaction, stroke: &Stroke, who: &Who) -> rusqlite::Result<Attempt> {
    let asked = Asked { kind: "stroke", sequence: &stroke.sequence, who, gone: &NONE };
    let mut edits: Vec<(ScanVersion, u64)> =
        stroke.scans.iter().map(|edit| (edit.version(&stroke.sequence), edit.base)).collect();
    edits.sort_by(|(a, _), (b, _)| a.key.cmp(&b.key));
    if let Some(made) = asked.made_before(on)? {
        return asked.answer_again(on, made, &edits).map(Attempt::Done);
    }
    if asked.is_taken(on)? {
        return Ok(Attempt::Taken);
    }
    let scans: Vec<ScanVersion> = edits.into_iter().map(|(version, _)| version).collect();
    let mut parts = Vec::with_capacity(stroke.scans.len());
    for edit in &stroke.scans {
        let scan = scan_id(on, &edit.version(&stroke.sequence))?;
        if let Some(conflict) = overtaken_base(on, scan, edit.base)? {
            return Ok(Attempt::Refused(Refusal { conflict, scans }));
        }
        parts.push(Part { scan, changes: changes(on, scan, stroke, edit)? });
    }
    let made = write(on, stroke, who, &parts)?;
    asked.answer(on, made, &scans).map(Attempt::Done)
}

/// The detections of a scan that the stroke says something of, with the corrections before.
fn changes(
    on: &Connection,
    scan: i64,
    stroke: &Stroke,
    edit: &ScanEdit,
) -> rusqlite::Result<Vec<(u32, Option<u16>)>> {
    let known: BTreeMap<u32, u16> = corrections(on, scan)?.into_iter().collect();
    let points: BTreeSet<u32> = edit.points.iter().copied().collect();
    let why: BTreeMap<u32, String> = match &stroke.cause {
        Some(_) => causes(on, scan)?.into_iter().collect(),
        None => BTreeMap::new(),
    };
    let with_before = points.into_iter().map(|point| (point, known.get(&point).copied()));
    let is_new = |point: &u32| stroke.cause.is_some() && why.get(point) != stroke.cause.as_ref();
    let changed = with_before.filter(|(point, before)| {
        let is_said = stroke.confirm || *before != stroke.label || is_new(point);
        is_said && !(stroke.protect && before.is_some())
    });
    Ok(changed.collect())
}

/// Writes what is changed, if anything is.
fn write(on: &Connection, stroke: &Stroke, who: &Who, parts: &[Part]) -> rusqlite::Result<Made> {
    let changed = parts.iter().map(|part| part.changes.len() as u64).sum();
    if changed == 0 {
        return Ok(Made { event: None, stroke: None, changed });
    }
    let event = log(on, "stroke", &stroke.sequence, who)?;
    let Stroke { sequence, tool, group, label, .. } = stroke;
    let new = NewStroke { event, sequence, tool, group: group.as_deref(), label: *label };
    let id = add_stroke(on, who, &new)?;
    if let Some(cause) = &stroke.cause {
        say(on, id, cause)?;
    }
    let mut change =
        on.prepare_cached("INSERT INTO change (stroke, scan, point, before, after) VALUES (?, ?, ?, ?, ?)")?;
    for part in parts.iter().filter(|part| !part.changes.is_empty()) {
        for (point, before) in &part.changes {
            change.execute(params![id, part.scan, point, before, label])?;
            correct(on, part.scan, *point, *label)?;
        }
        log_scan(on, event, part.scan, true)?;
    }
    Ok(Made { event: Some(event), stroke: Some(id), changed })
}
