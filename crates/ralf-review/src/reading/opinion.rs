//! What the labels would be, after what people said of some of them.

use super::said::Said;
use super::{read_time, things};
use crate::app::App;
use crate::http::{Answer, ApiError, json};
use crate::labelled::SequenceLabels;
use ralf::label::{ARTIFACT, PLAUSIBLE};
use ralf::sensors::Sequence;
use ralf_data::things::{self as data, Change, SequenceEvidence, SequenceThings};
use ralf_data::{ScanIndex, SequenceReader};
use serde::Deserialize;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::thread::available_parallelism;

/// Around which moment, where a sequence is too long to be learned from as a whole.
#[derive(Debug, Deserialize)]
pub(crate) struct Around {
    /// ns
    #[serde(default)]
    t_ns: Option<String>,
}

/// It's thought over again so often where people say more meanwhile.
const ROUNDS: usize = 3;

/// Which things would be called otherwise by who has learned from what was said; nothing is changed by that. The first
/// time all evidence is gathered, which takes a while.
pub(crate) fn opinion(app: &App, sequence: &str, asked: &Around) -> Answer {
    let t_ns = asked.t_ns.as_deref().map_or(Ok(0), read_time)?;
    let (index, reader) = app.sequence(sequence)?;
    let labels = app.labels(index)?;
    let things = labels.things(reader)?;
    let said = || Said::of(app, reader.sequence())?.answers(app, &things);
    let opinion = by_all_that_is_said(said, |answers| learned(app, reader, &labels, &things, t_ns, answers));
    opinion.and_then(|opinion| json(&opinion))
}

/// What is found by what people say; found again where somebody says more meanwhile, for revisions that are read after
/// that belong to it only if nobody has.
pub(super) fn by_all_that_is_said<T: PartialEq>(
    said: impl Fn() -> Result<T, ApiError>,
    find: impl Fn(&T) -> Result<Value, ApiError>,
) -> Result<Value, ApiError> {
    let mut known = said()?;
    for _ in 0..ROUNDS {
        let found = find(&known)?;
        let now = said()?;
        if now == known {
            return Ok(found);
        }
        known = now;
    }
    let sentence = "somebody says more all the time: ask again when that is done";
    Err(ApiError::Conflict(sentence.into(), Map::new()))
}

/// What would change by these answers, and what strokes on those scans rest on.
fn learned(
    app: &App,
    reader: &dyn SequenceReader,
    labels: &SequenceLabels,
    things: &SequenceThings,
    t_ns: i64,
    answers: &[Option<data::Answer>],
) -> Result<Value, ApiError> {
    let jobs = half_of_the_machine();
    if answers.iter().all(Option::is_none) {
        return Ok(json!({ "answered": 0, "changes": [], "base": [], "scans": null }));
    }
    let observed = labels.observed(reader, things, t_ns, jobs)?;
    let answered = things.answered(&observed, answers);
    let sequence = reader.sequence();
    let asks = app.team.asks(sequence);
    let mut changes = things.second_opinion(&observed, answers, jobs);
    changes.retain(|change| change.rows.iter().any(|row| asks(things.scan_of(*row))));
    let base = bases(app, sequence, things, changes.iter().flat_map(|change| &change.rows))?;
    let changes: Vec<Value> = changes.iter().map(|change| row(sequence, things, change)).collect();
    Ok(json!({ "answered": answered, "changes": changes, "base": base, "scans": looked_at(&observed) }))
}

/// How much of a sequence was learned from, of what could be.
pub(super) fn looked_at(observed: &SequenceEvidence) -> Value {
    json!({ "looked_at": observed.scans_looked_at, "all": observed.scans_with_detections })
}

/// So many threads: somebody goes on working meanwhile, and the other half is theirs.
pub(super) fn half_of_the_machine() -> usize {
    available_parallelism().map_or(1, |threads| threads.get().div_ceil(2))
}

/// What strokes on the scans of these detections rest on.
pub(super) fn bases<'a>(
    app: &App,
    sequence: &Sequence,
    things: &SequenceThings,
    rows: impl IntoIterator<Item = &'a usize>,
) -> Result<Vec<Value>, ApiError> {
    let scans: BTreeSet<ScanIndex> = rows.into_iter().map(|row| things.scan_of(*row)).collect();
    scans.into_iter().map(|scan| base(app, sequence, scan)).collect()
}

/// What a stroke on a scan rests on.
fn base(app: &App, sequence: &Sequence, ScanIndex { radar, scan }: ScanIndex) -> Result<Value, ApiError> {
    let place = app.scan(&sequence.name, &sequence.rig.radars[radar].name, scan)?;
    let version = app.known_version(place)?;
    let revision = app.said(|store| store.scan(&version))?.revision;
    let content = version.content.hash.map(|hash| hash.to_string());
    Ok(json!({ "radar": version.key.radar, "scan": scan, "revision": revision, "content": content }))
}

/// A thing with what it would be, and the detections that this would change.
fn row(sequence: &Sequence, known: &SequenceThings, change: &Change) -> Value {
    let mut row = things::row(sequence, &change.thing);
    row["label"] = json!(if change.plausible { PLAUSIBLE } else { ARTIFACT });
    row["probability"] = json!(change.probability);
    row["points"] = things::points(sequence, known, &change.rows);
    row
}
