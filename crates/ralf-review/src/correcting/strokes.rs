//! Strokes, undo and redo.

use super::answers;
use crate::app::App;
use crate::http::{Answer, ApiError, json};
use ralf::label::class_name;
use ralf_corrections::{ScanEdit, Stroke};
use serde::{Deserialize, Deserializer};
use std::collections::{BTreeMap, BTreeSet};

/// The longest name of a tool or group, bytes.
const LONGEST_NAME: usize = 64;

/// A stroke, as the page sends it.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct StrokeRequest {
    tool: String,
    #[serde(default)]
    group: Option<String>,
    #[serde(default)]
    protect: bool,
    /// Must be there: its absence is no wish to take corrections away.
    #[serde(deserialize_with = "present")]
    label: Option<u16>,
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
}

/// Detections of a scan.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Points {
    radar: String,
    scan: usize,
    points: Vec<u32>,
}

/// `{}`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Nothing {}

fn present<'de, D: Deserializer<'de>>(value: D) -> Result<Option<u16>, D::Error> {
    Option::deserialize(value)
}

/// Writes a stroke.
pub(crate) fn stroke(app: &App, sequence: &str, asked: StrokeRequest, tab: Option<String>) -> Answer {
    let stroke = checked(app, sequence, asked)?;
    let written = app.store().apply(&stroke, &app.who(tab))?;
    answers::outcome(app, written)
}

/// Takes the author's last stroke back.
pub(crate) fn undo(app: &App, sequence: &str, tab: Option<String>) -> Answer {
    app.sequence(sequence)?;
    let written = app.store().undo(sequence, &app.who(tab))?;
    answers::outcome(app, written)
}

/// Sets the stroke again that the author took back last.
pub(crate) fn redo(app: &App, sequence: &str, tab: Option<String>) -> Answer {
    app.sequence(sequence)?;
    let written = app.store().redo(sequence, &app.who(tab))?;
    answers::outcome(app, written)
}

/// What the author can undo and redo.
pub(crate) fn history(app: &App, sequence: &str) -> Answer {
    app.sequence(sequence)?;
    let found = app.store().history(sequence, &app.author)?;
    json(&answers::history(&found))
}

/// The stroke in the store's terms. Refused is what makes no sense.
fn checked(app: &App, sequence: &str, asked: StrokeRequest) -> Result<Stroke, ApiError> {
    check_name("tool", &asked.tool)?;
    asked.group.as_deref().map_or(Ok(()), |group| check_name("group", group))?;
    if let Some(unknown) = asked.label.filter(|id| class_name(*id).is_none()) {
        return Err(malformed(format!("label: expected an id of SemanticKITTI, found {unknown}")));
    }
    let bases: BTreeMap<(&str, usize), u64> =
        asked.base.iter().map(|base| ((base.radar.as_str(), base.scan), base.revision)).collect();
    let mut seen = BTreeSet::new();
    let mut scans = Vec::with_capacity(asked.points.len());
    for Points { radar, scan, points } in &asked.points {
        let place = app.scan(sequence, radar, *scan)?;
        let base = bases.get(&(radar.as_str(), *scan)).copied();
        let base = base.ok_or_else(|| {
            malformed(format!("base: expected the revision of {radar} scan {scan}, found none"))
        })?;
        if !seen.insert((radar, scan)) {
            return Err(malformed(format!("points: expected {radar} scan {scan} once, found it twice")));
        }
        let detections = app.labels(place.sequence)?.reader.detections(radar, *scan);
        let detections = u32::try_from(detections).map_err(|error| malformed(error.to_string()))?;
        let (radar, scan, points) = (radar.clone(), place.key.scan, points.clone());
        scans.push(ScanEdit { radar, scan, detections, base, points });
    }
    app.sequence(sequence)?;
    let StrokeRequest { tool, group, protect, label, .. } = asked;
    Ok(Stroke { sequence: sequence.to_owned(), tool, group, protect, label, scans })
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
