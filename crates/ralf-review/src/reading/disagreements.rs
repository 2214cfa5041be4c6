//! Where two people said different things of the same detections, neither of whom saw what the other said.

use super::opinion::{bases, by_all_that_is_said};
use super::things;
use crate::app::App;
use crate::causes::sayable;
use crate::http::{Answer, ApiError, json};
use ralf::sensors::Sequence;
use ralf_corrections::FILE;
use ralf_data::judge::{Difference, compare, is_about_plausibility};
use ralf_data::result::RadarScanKey;
use ralf_data::team::second_labellers;
use ralf_data::things::{SequenceThings, Thing};
use ralf_data::{Corrections, ScanId, ScanIndex, SequenceReader};
use serde_json::{Value, json};
use std::cmp::Reverse;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// What somebody said of a detection: the label, and why it is an artifact where that was said, too.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Said {
    label: u16,
    cause: Option<&'static str>,
}

/// What two people said of a thing that they labelled differently.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Dispute {
    /// The thing's number.
    thing: u32,
    first: Said,
    second: Said,
    /// Who the second is.
    by: String,
}

/// How far people agree who labelled scans of a sequence twice, and where they don't. Only scans that both are through
/// with are told: nobody is influenced by what another said.
pub(crate) fn disagreements(app: &App, sequence: &str) -> Answer {
    let (index, reader) = app.sequence(sequence)?;
    if app.team.second.is_some() {
        let sentence = "who labels a second time sees nobody else's labels: open the review without --second";
        return Err(ApiError::Forbidden(sentence.into()));
    }
    let known = app.labels(index)?.things(reader)?;
    // Of the store that the server has open, which notices when it was deleted: what is read below is opened anew.
    let said = || app.said(|store| store.counter_of(sequence));
    by_all_that_is_said(said, |_| found(app, (index, reader), &known)).and_then(|found| json(&found))
}

/// Where people disagree, and what strokes on those scans rest on.
fn found(
    app: &App,
    (index, reader): (usize, &dyn SequenceReader),
    known: &SequenceThings,
) -> Result<Value, ApiError> {
    let first = through(app, (index, reader), &app.out.join(FILE))?;
    let (mut told, mut found, mut both) = (Vec::new(), BTreeMap::new(), BTreeSet::new());
    for (name, file) in second_labellers(&app.out)? {
        let second = through(app, (index, reader), &file)?;
        let (second, left_out) = match app.team.twice_of(&name) {
            Some(dealt) => dealt.among(second),
            None => (second, 0),
        };
        let (agreement, differences) = compare(&first, &second)?;
        // Of a scan without detections nobody labels anything, and people are through with it all the same.
        let theirs: BTreeSet<&ScanId> = second.scans().collect();
        let common = first.scans().filter(|scan| theirs.contains(scan));
        both.extend(common.map(|scan| RadarScanKey::new(&scan.radar, scan.scan as usize)));
        let scans = agreement.scans.len();
        let agreement = agreement.json();
        told.push(json!({ "second": name, "scans": scans, "left_out": left_out, "agreement": agreement }));
        gather(reader.sequence(), known, &differences, &name, &mut found);
    }
    let base = bases(app, reader.sequence(), known, found.values().flatten())?;
    let twice = app.team.twice(&reader.sequence().name);
    let waiting = twice.map(|twice| twice.difference(&both).count());
    let changes = rows(reader.sequence(), known, found);
    Ok(json!({ "people": told, "waiting": waiting, "changes": changes, "base": base }))
}

/// What somebody said of the scans of a sequence that it is through with.
fn through(
    app: &App,
    (index, reader): (usize, &dyn SequenceReader),
    file: &Path,
) -> Result<Corrections, ApiError> {
    let sequence = reader.sequence();
    let bound = Corrections::open(file)?.bound(|scan| {
        let there = scan.place_in(sequence);
        Ok::<_, ApiError>(there.and_then(|at| app.contents.known(reader, (index, at))))
    });
    // Who was through with what a scan held before may not be through with what it holds now.
    bound.map(Corrections::of_reviewed_scans)
}

/// Adds differences to those of the same thing, of which the same was said.
fn gather(
    sequence: &Sequence,
    known: &SequenceThings,
    differences: &[Difference],
    name: &str,
    found: &mut BTreeMap<Dispute, Vec<usize>>,
) {
    for difference in differences {
        let Some(scan) = difference.scan.place_in(sequence) else { continue };
        let Some(row) = known.rows_of(scan).nth(difference.point) else { continue };
        let said = |label, cause: &Option<String>| Said { label, cause: known_cause(cause.as_deref()) };
        let first = said(difference.first, &difference.first_cause);
        let second = said(difference.second, &difference.second_cause);
        // Of a cause that this program doesn't know nothing can be said.
        if first.label == second.label && (first.cause.is_none() || second.cause.is_none()) {
            continue;
        }
        let dispute = Dispute { thing: known.things()[row], first, second, by: name.to_owned() };
        found.entry(dispute).or_default().push(row);
    }
}

/// A cause that a stroke may say.
fn known_cause(name: Option<&str>) -> Option<&'static str> {
    sayable().into_iter().find(|known| !known.is_empty() && Some(*known) == name)
}

/// Those first of which only one says that they are plausible, then those about labels, then those about causes alone;
/// and of these the largest.
fn rows(sequence: &Sequence, known: &SequenceThings, found: BTreeMap<Dispute, Vec<usize>>) -> Vec<Value> {
    let mut order: Vec<(Dispute, Vec<usize>)> = found.into_iter().collect();
    order.sort_by_key(|(Dispute { first, second, .. }, rows)| {
        let is_about_plausibility = is_about_plausibility(first.label, second.label);
        (!is_about_plausibility, first.label == second.label, Reverse(rows.len()))
    });
    let described = known.described();
    let told = |(dispute, rows): &(Dispute, Vec<usize>)| {
        row(sequence, known, &described(dispute.thing), dispute, rows)
    };
    order.iter().map(told).collect()
}

fn row(
    sequence: &Sequence,
    known: &SequenceThings,
    thing: &Thing,
    Dispute { first, second, by, .. }: &Dispute,
    rows: &[usize],
) -> Value {
    let mut row = things::row(sequence, thing);
    row["points"] = things::points(sequence, known, rows);
    // The thing itself may have been seen elsewhere only: what is in question is looked at.
    let (ScanIndex { radar, scan }, point) = known.place_of(rows[rows.len() / 2]);
    row["radar"] = json!(sequence.rig.radars[radar].name);
    (row["scan"], row["point"]) = (json!(scan), json!(point));
    (row["first"], row["second"], row["by"]) = (json!(first.label), json!(second.label), json!(by));
    (row["first_cause"], row["second_cause"]) = (json!(first.cause), json!(second.cause));
    row
}
