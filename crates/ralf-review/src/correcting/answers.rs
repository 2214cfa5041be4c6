//! What the store says, in the words of the interface.

use crate::app::App;
use crate::http::{Answer, ApiError, json};
use ralf_corrections::{Conflict, Edit, History, Outcome, ScanState, Step};
use serde_json::{Map, Value, json};

/// The answer to an edit. Other windows hear of one that was written.
pub(crate) fn outcome(app: &App, outcome: Outcome) -> Answer {
    match outcome {
        Outcome::Done(edit) => {
            app.news.send_replace(());
            done(&edit)
        }
        Outcome::Conflict(found) => Err(conflict(found)),
    }
}

fn done(edit: &Edit) -> Answer {
    json(&json!({
        "stroke": edit.stroke,
        "changed": edit.changed,
        "scans": edit.scans.iter().map(scan).collect::<Vec<_>>(),
        "history": history(&edit.history),
    }))
}

/// Nothing was written: another edit came first.
pub(crate) fn conflict(found: Conflict) -> ApiError {
    let Conflict { author, at, tool, radar, scan: number, scans } = &found;
    let sentence = format!(
        "{radar} scan {number}: expected no other edit, found that {author} changed it at {at} ({tool})"
    );
    let more = json!({ "author": author, "at": at, "tool": tool, "radar": radar, "scan": number });
    let scans: Vec<Value> = scans.iter().map(scan).collect();
    let more = [("conflict".to_owned(), more), ("scans".to_owned(), Value::Array(scans))];
    ApiError::Conflict(sentence, Map::from_iter(more))
}

fn scan(state: &ScanState) -> Value {
    json!({
        "radar": state.key.radar,
        "scan": state.key.scan,
        "revision": state.revision,
        "corrections": state.corrections,
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
