//! Which detections all over a sequence one question can be about.

use super::opinion::{bases, by_all_that_is_said, half_of_the_machine, looked_at};
use super::said::Said;
use super::{read_time, things};
use crate::app::App;
use crate::http::{Answer, ApiError, json};
use ralf::label::{ARTIFACT, PLAUSIBLE};
use ralf::sensors::Sequence;
use ralf_data::ScanIndex;
use ralf_data::things::{Kind, KindName, SequenceThings};
use serde::Deserialize;
use serde_json::{Value, json};
use std::collections::BTreeSet;

/// Around which moment, and what was passed over.
#[derive(Debug, Deserialize)]
pub(crate) struct AskedKinds {
    /// ns
    #[serde(default)]
    t_ns: Option<String>,
    /// Names of kinds, with a comma between two.
    #[serde(default)]
    passed: Option<String>,
}

/// The kind whose answer is worth most. Nothing is changed by asking; the first time all evidence is gathered, which
/// takes a while.
pub(crate) fn kinds(app: &App, sequence: &str, asked: &AskedKinds) -> Answer {
    let t_ns = asked.t_ns.as_deref().map_or(Ok(0), read_time)?;
    let passed = passed(asked.passed.as_deref().unwrap_or_default())?;
    let (index, reader) = app.sequence(sequence)?;
    let labels = app.labels(index)?;
    let things = labels.things(reader)?;
    let observed = labels.observed(reader, &things, t_ns, half_of_the_machine())?;
    let asks = app.team.asks(reader.sequence());
    let said = || Said::of(app, reader.sequence())?.answers(app, &things);
    let question = by_all_that_is_said(said, |answers| {
        let mut found = things.kinds(&observed, answers, &passed);
        found.retain(|kind| kind.rows.iter().any(|row| asks(things.scan_of(*row))));
        let rows = found.first().map(|kind| kind.rows.as_slice()).unwrap_or_default();
        Ok(json!({
            "kinds": found.len(),
            "next": found.first().map(|kind| row(reader.sequence(), &things, kind)),
            "base": bases(app, reader.sequence(), &things, rows)?,
            "scans": looked_at(&observed),
        }))
    });
    question.and_then(|question| json(&question))
}

fn passed(names: &str) -> Result<BTreeSet<KindName>, ApiError> {
    let known = |name: &str| {
        let name = name.parse();
        name.map_err(|()| {
            ApiError::Malformed("query: passed: expected names of kinds, as they are told".into())
        })
    };
    names.split(',').filter(|name| !name.is_empty()).map(known).collect()
}

fn row(sequence: &Sequence, known: &SequenceThings, kind: &Kind) -> Value {
    let of_things: BTreeSet<u32> = kind.rows.iter().map(|row| known.things()[*row]).collect();
    let mut by_time = kind.rows.clone();
    by_time.sort_by_key(|row| (known.sightings()[*row].t_ns, *row));
    let ScanIndex { radar, scan } = known.scan_of(by_time[by_time.len() / 2]);
    json!({
        "kind": kind.name.to_string(),
        "sign": kind.name.sign.name(),
        "label": if kind.name.plausible { PLAUSIBLE } else { ARTIFACT },
        "detections": kind.rows.len(),
        "things": of_things.len(),
        "expected_errors": kind.expected_errors,
        "worth": kind.worth,
        "radar": sequence.rig.radars[radar].name,
        "scan": scan,
        "points": things::points(sequence, known, &kind.rows),
        "ranks": kind.ranks,
        "asked": kind.asked,
    })
}
