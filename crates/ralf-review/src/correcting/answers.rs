//! What the store says, in the words of the interface.

use crate::app::App;
use crate::causes;
use crate::http::{Answer, ApiError, json};
use crate::reading::reviewed;
use ralf_corrections::{Conflict, Edit, History, Outcome, ScanState, Step};
use serde_json::{Map, Value, json};

/// The answer to an edit.
pub(crate) fn outcome(app: &App, outcome: Outcome) -> Answer {
    match outcome {
        Outcome::Done(edit) => json(&Value::Object(done(app, &edit))),
        Outcome::Conflict(found) => Err(conflict(app, &found)),
    }
}

/// An edit that is on disk.
pub(crate) fn done(app: &App, edit: &Edit) -> Map<String, Value> {
    Map::from_iter([
        ("stroke".to_owned(), json!(edit.stroke)),
        ("changed".to_owned(), json!(edit.changed)),
        ("scans".to_owned(), scans(app, &edit.scans)),
        ("history".to_owned(), history(&edit.history)),
    ])
}

/// Nothing was written: another edit came first.
pub(crate) fn conflict(app: &App, found: &Conflict) -> ApiError {
    let Conflict { author, at, tool, radar, scan: number, scans: states } = found;
    let is_met = |state: &&ScanState| state.key.radar == *radar && state.key.scan == *number;
    let (sentence, more) = if author.is_empty() {
        let revision = states.iter().find(is_met).map_or(0, |state| state.revision);
        let expected = format!("expected the revision that it has, {revision}");
        let found = "found a later one, of which these corrections know nothing; look at it again";
        (format!("{radar} scan {number}: {expected}, {found}"), Value::Null)
    } else {
        let found = format!("{author} changed it at {at} ({tool})");
        let more = json!({ "author": author, "at": at, "tool": tool, "radar": radar, "scan": number });
        (format!("{radar} scan {number}: expected no other edit, found that {found}"), more)
    };
    let more = [("conflict".to_owned(), more), ("scans".to_owned(), scans(app, states))];
    ApiError::Conflict(sentence, Map::from_iter(more))
}

/// Nothing was written: what is on screen is not what lies there now.
pub(crate) fn stale(sentence: String) -> ApiError {
    let more = [("conflict", Value::Null), ("stale", json!(true)), ("scans", json!([]))];
    ApiError::Conflict(sentence, more.into_iter().map(|(name, value)| (name.to_owned(), value)).collect())
}

/// A stamp that a request names against the one that holds now.
pub(crate) fn check_seen(place: &str, what: &str, seen: &str, now: &str) -> Result<(), ApiError> {
    if seen == now {
        return Ok(());
    }
    Err(stale(format!("{place}: expected {what} that were on screen, found others; look at it again")))
}

/// Scans as they are; those left out whose corrections belong to what they held before.
fn scans(app: &App, states: &[ScanState]) -> Value {
    states.iter().filter(|state| holds(app, state)).map(scan).collect()
}

fn holds(app: &App, state: &ScanState) -> bool {
    let key = &state.key;
    let place = app.scan(&key.sequence, &key.radar, key.scan as usize);
    let content = place.and_then(|place| app.content(&place));
    content.is_ok_and(|content| state.content.is_none() || state.content == content.hash)
}

fn scan(state: &ScanState) -> Value {
    json!({
        "radar": state.key.radar,
        "scan": state.key.scan,
        "revision": state.revision,
        "corrections": state.corrections,
        "causes": causes::numbered(state).collect::<Vec<_>>(),
        "reviewed": reviewed(state),
    })
}

/// What an author can undo and redo.
pub(crate) fn history(history: &History) -> Value {
    json!({
        "undo": history.undo.as_ref().map(step),
        "redo": history.redo.as_ref().map(step),
        "undo_depth": history.undo_depth,
        "redo_depth": history.redo_depth,
    })
}

fn step(step: &Step) -> Value {
    json!({ "tool": step.tool, "label": step.label, "changed": step.changed, "at": step.at })
}
