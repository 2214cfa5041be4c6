//! Marking scans as reviewed.

use super::answers;
use crate::app::App;
use crate::http::{Answer, json};
use crate::reading;
use ralf_corrections::{Mark, Outcome};
use serde::Deserialize;
use serde_json::json;

/// The mark that is wanted.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct MarkRequest {
    reviewed: bool,
    revision: u64,
}

/// Sets a scan's mark or takes it away.
pub(crate) fn mark(
    app: &App,
    (sequence, radar, scan): (&str, &str, usize),
    asked: &MarkRequest,
    tab: Option<String>,
) -> Answer {
    let place = app.scan(sequence, radar, scan)?;
    let rows = app.labels(place.sequence)?.table(radar, scan, place.t_ns)?;
    let machine = reading::machine_labels(&rows);
    let mark = Mark { key: place.key, base: asked.revision, machine, reviewed: asked.reviewed };
    let written = app.store().mark(&mark, &app.who(tab))?;
    match written {
        Outcome::Conflict(found) => Err(answers::conflict(found)),
        Outcome::Done(marked) => {
            app.news.send_replace(());
            let reviewed = marked.map(|mark| json!({ "author": mark.author, "at": mark.at }));
            json(&json!({ "reviewed": reviewed, "progress": reading::progress(app, sequence)? }))
        }
    }
}
