//! Strokes, undo and redo.

use super::answers;
use crate::app::App;
use crate::causes::sayable;
use crate::http::{Answer, ApiError, EditId, Person, json};
use ralf::label::{class_name, truth_of};
use ralf_corrections::{SETTLE, ScanEdit, Stroke};
use serde::{Deserialize, Deserializer};
use std::collections::{BTreeMap, BTreeSet};

/// The longest name of a tool or group, bytes.
const LONGEST_NAME: usize = 64;

/// A stroke, as the page sends it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StrokeRequest {
    #[serde(default)]
    id: Option<EditId>,
    tool: String,
    #[serde(default)]
    group: Option<String>,
    #[serde(default)]
    protect: bool,
    #[serde(default)]
    confirm: bool,
    /// Must be there: its absence is no wish to take corrections away.
    #[serde(deserialize_with = "present")]
    label: Option<u16>,
    /// Why it is so.
    #[serde(default)]
    cause: Option<String>,
    base: Vec<Base>,
    points: Vec<Points>,
}

/// The revision of a scan that the author saw.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Base {
    radar: String,
    scan: usize,
    revision: u64,
    /// What the scan on screen holds.
    #[serde(default)]
    content: Option<String>,
}

/// Detections of a scan.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Points {
    radar: String,
    scan: usize,
    points: Vec<u32>,
}

/// One step back or forth.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StepRequest {
    #[serde(default)]
    id: Option<EditId>,
}

fn present<'de, D: Deserializer<'de>>(value: D) -> Result<Option<u16>, D::Error> {
    Option::deserialize(value)
}

/// Writes a stroke.
pub(crate) fn stroke(app: &App, sequence: &str, asked: StrokeRequest, person: Person) -> Answer {
    let who = app.who(person, asked.id.clone());
    let stroke = checked(app, sequence, asked)?;
    answers::outcome(app, app.edit(sequence, &who, |store, _| store.apply(&stroke, &who))?)
}

/// Takes the person's own last step back.
pub(crate) fn undo(app: &App, sequence: &str, asked: StepRequest, person: Person) -> Answer {
    app.sequence(sequence)?;
    let who = app.who(person, asked.id);
    answers::outcome(app, app.edit(sequence, &who, |store, gone| store.undo_without(sequence, &who, gone))?)
}

/// Sets the step again that the person took back last.
pub(crate) fn redo(app: &App, sequence: &str, asked: StepRequest, person: Person) -> Answer {
    app.sequence(sequence)?;
    let who = app.who(person, asked.id);
    answers::outcome(app, app.edit(sequence, &who, |store, gone| store.redo_without(sequence, &who, gone))?)
}

/// What the person can undo and redo.
pub(crate) fn history(app: &App, sequence: &str, person: Person) -> Answer {
    app.sequence(sequence)?;
    let who = app.who(person, None);
    json(&answers::history(&app.history(sequence, &who)?))
}

/// The stroke in the store's terms. Refused is what makes no sense.
fn checked(app: &App, sequence: &str, asked: StrokeRequest) -> Result<Stroke, ApiError> {
    check_name("tool", &asked.tool)?;
    asked.group.as_deref().map_or(Ok(()), |group| check_name("group", group))?;
    check_label(&asked.tool, asked.label)?;
    check_cause(asked.cause.as_deref(), asked.label)?;
    let bases: BTreeMap<(&str, usize), &Base> =
        asked.base.iter().map(|base| ((base.radar.as_str(), base.scan), base)).collect();
    let mut seen = BTreeSet::new();
    let mut scans = Vec::with_capacity(asked.points.len());
    for part in &asked.points {
        let Points { radar, scan, .. } = part;
        let base = bases.get(&(radar.as_str(), *scan)).copied().ok_or_else(|| {
            malformed(format!("base: expected the revision of {radar} scan {scan}, found none"))
        })?;
        if !seen.insert((radar, scan)) {
            return Err(malformed(format!("points: expected {radar} scan {scan} once, found it twice")));
        }
        scans.push(edit(app, sequence, part, base)?);
    }
    app.sequence(sequence)?;
    let StrokeRequest { tool, group, protect, confirm, label, cause, .. } = asked;
    Ok(Stroke { sequence: sequence.to_owned(), tool, group, protect, confirm, label, cause, scans })
}

/// A stroke's part in a scan, which must hold what was on screen.
fn edit(app: &App, sequence: &str, part: &Points, base: &Base) -> Result<ScanEdit, ApiError> {
    let Points { radar, scan, points } = part;
    let place = app.scan(sequence, radar, *scan)?;
    let content = app.content(&place)?;
    if let (Some(seen), Some(now)) = (&base.content, content.hash) {
        let scan = format!("{radar} scan {scan}");
        answers::check_seen(&scan, "the detections", seen, &now.to_string())?;
    }
    Ok(ScanEdit {
        radar: radar.clone(),
        scan: place.key.scan,
        detections: content.detections,
        content: content.hash,
        base: base.revision,
        points: points.clone(),
    })
}

/// Nobody sets classes without a name. Who settles may find that a person is right who accepted one from the machine,
/// whose classes go by the LiDAR points' own labels.
fn check_label(tool: &str, label: Option<u16>) -> Result<(), ApiError> {
    match label.filter(|id| tool != SETTLE && class_name(*id).is_none()) {
        None => Ok(()),
        Some(unknown) => Err(malformed(format!("label: expected an id of SemanticKITTI, found {unknown}"))),
    }
}

/// Only an artifact has a cause, and one that is known.
fn check_cause(cause: Option<&str>, label: Option<u16>) -> Result<(), ApiError> {
    let Some(cause) = cause else { return Ok(()) };
    if cause.is_empty() || !sayable().contains(&cause) {
        let known = sayable()[1..].join(", ");
        return Err(malformed(format!("cause: expected one of {known}, found `{cause}`")));
    }
    match label.and_then(truth_of) {
        Some(false) => Ok(()),
        _ => {
            let found = label.map_or("none".to_owned(), |label| label.to_string());
            Err(malformed(format!("label: expected an artifact's where a cause is said, found {found}")))
        }
    }
}

fn check_name(what: &str, name: &str) -> Result<(), ApiError> {
    if (1..=LONGEST_NAME).contains(&name.len()) && !name.chars().any(char::is_control) {
        return Ok(());
    }
    Err(malformed(format!(
        "{what}: expected a name of 1 to {LONGEST_NAME} bytes, found {} bytes",
        name.len()
    )))
}

fn malformed(sentence: String) -> ApiError {
    ApiError::Malformed(sentence)
}
