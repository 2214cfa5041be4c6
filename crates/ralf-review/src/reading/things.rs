//! What belongs together in a sequence, and which of it wants an answer.

use super::said::Said;
use crate::app::App;
use crate::http::{self, ApiError, Table, content};
use ralf::sensors::Sequence;
use ralf_data::ScanIndex;
use ralf_data::things::{SequenceThings, Thing};
use serde_json::{Map, Value, json};
use std::sync::Arc;

/// The most things of the queue that are told at once.
const MOST: usize = 500;

/// The thing of every detection of a sequence, scan by scan, and the things with the most expected errors.
pub(crate) fn things(app: &App, sequence: &str) -> http::Answer {
    let (sequence, known, mut header) = asked(app, sequence)?;
    let scans = known.scans().iter().map(|at| {
        let rows = known.rows_of(*at).len();
        json!({ "radar": sequence.rig.radars[at.radar].name, "scan": at.scan, "rows": rows })
    });
    header.insert("scans".to_owned(), scans.collect());
    let mut table = Table::new(known.things().len());
    table.u32("thing", known.things().iter().copied());
    Ok(content("application/octet-stream", table.finish(header)))
}

/// The things with the most expected errors alone: they are others after each answer.
pub(crate) fn doubtful(app: &App, sequence: &str) -> http::Answer {
    let (_, _, header) = asked(app, sequence)?;
    http::json(&Value::Object(header))
}

/// A sequence, what belongs together in it, and what is told of that.
type Asked<'a> = (&'a Sequence, Arc<SequenceThings>, Map<String, Value>);

fn asked<'a>(app: &'a App, name: &str) -> Result<Asked<'a>, ApiError> {
    let (index, reader) = app.sequence(name)?;
    let labels = app.labels(index)?;
    let things = labels.things(reader)?;
    let sequence = reader.sequence();
    let answers = Said::of(app, reader.sequence())?.answers(app, &things)?;
    let doubtful = things.doubtful(&answers, MOST, app.team.asks(sequence));
    let header = Map::from_iter([
        ("run".to_owned(), json!(labels.run())),
        ("doubtful".to_owned(), doubtful.things.iter().map(|thing| row(sequence, thing)).collect()),
        ("things".to_owned(), json!(things.count())),
        ("expected_errors".to_owned(), json!(doubtful.expected_errors)),
    ]);
    Ok((sequence, things, header))
}

/// Which detections these are, scan by scan.
pub(super) fn points(sequence: &Sequence, known: &SequenceThings, rows: &[usize]) -> Value {
    let part = |rows: &[usize]| {
        let ScanIndex { radar, scan } = known.scan_of(rows[0]);
        let points: Vec<usize> = rows.iter().map(|row| known.place_of(*row).1).collect();
        json!({ "radar": sequence.rig.radars[radar].name, "scan": scan, "points": points })
    };
    rows.chunk_by(|a, b| known.scan_of(*a) == known.scan_of(*b)).map(part).collect()
}

pub(super) fn row(sequence: &Sequence, thing: &Thing) -> Value {
    let (ScanIndex { radar, scan }, point) = thing.seen;
    json!({
        "thing": thing.number,
        "place": thing.place.map(|metres| metres.is_finite().then_some(metres)),
        "radius": thing.radius.is_finite().then_some(thing.radius),
        "detections": thing.detections,
        "scans": thing.scans,
        "plausible": thing.plausible,
        "answered": thing.answered,
        "expected_errors": thing.expected_errors,
        "radar": sequence.rig.radars[radar].name,
        "scan": scan,
        "point": point,
    })
}
