//! Marking scans as reviewed.

use super::answers;
use crate::app::App;
use crate::http::{Answer, ApiError, EditId, Person, json};
use crate::reading;
use ralf_corrections::{Mark, Outcome};
use serde::Deserialize;
use serde_json::{Value, json};

/// The mark that is wanted.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MarkRequest {
    #[serde(default)]
    id: Option<EditId>,
    reviewed: bool,
    revision: u64,
    /// Of the labels on screen, which are accepted; not needed to take a mark away.
    #[serde(default)]
    stamp: Option<String>,
}

/// Sets a scan's mark or takes it away. Labels that were not on screen are never accepted.
pub(crate) fn mark(
    app: &App,
    (sequence, radar, scan): (&str, &str, usize),
    asked: MarkRequest,
    person: Person,
) -> Answer {
    let place = app.scan(sequence, radar, scan)?;
    let rows = app.labels(place.sequence)?.table(radar, scan)?;
    let version = app.version(&place)?;
    reading::check_size(&version, &rows)?;
    let machine = reading::machine_labels(&rows)?;
    let content = version.content.hash;
    if asked.reviewed {
        let seen = asked.stamp.as_deref().ok_or_else(|| {
            ApiError::Malformed("stamp: expected that of the labels on screen, found none".into())
        })?;
        let now = reading::stamp(content.as_ref(), &machine);
        answers::check_seen(&format!("{radar} scan {scan}"), "the labels", seen, &now)?;
    }
    let mark = Mark { key: place.key, content, base: asked.revision, machine, reviewed: asked.reviewed };
    let who = app.who(person, asked.id);
    match app.edit(sequence, &who, |store, _| store.mark(&mark, &who))? {
        Outcome::Conflict(found) => Err(answers::conflict(app, &found)),
        Outcome::Done(edit) => {
            let mut answer = answers::done(app, &edit);
            let mark = edit.scans.first().map_or(Value::Null, reading::reviewed);
            answer.insert("reviewed".to_owned(), mark);
            answer.insert("progress".to_owned(), reading::progress(app, sequence)?);
            json(&json!(answer))
        }
    }
}
