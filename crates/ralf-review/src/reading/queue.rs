//! Which scan wants a person next.

use super::said::Said;
use super::time;
use crate::app::App;
use crate::http::{Answer, ApiError, json};
use crate::need::ScanNeed;
use ralf::sensors::Sequence;
use ralf_data::result::RadarScanKey;
use ralf_data::{ScanIndex, SequenceReader};
use serde_json::{Value, json};

/// Every labelled radar scan of a sequence: those that nobody has reviewed first, and of these the ones with the most
/// wrong labels, as far as can be expected.
pub(crate) fn queue(app: &App, sequence: &str) -> Answer {
    let (index, reader) = app.sequence(sequence)?;
    let labels = app.labels(index)?;
    let needs = labels.needs(reader)?;
    let needs = queued(app, reader, &needs);
    let said = Said::of(app, reader.sequence())?;
    let left: Vec<f64> = if said.holding.is_empty() {
        // While nobody has said anything the machine's own doubt is what is left: no scan is read for that.
        needs.iter().map(|need| need.doubts.expected_errors).collect()
    } else {
        let things = labels.things(reader)?;
        let errors = things.expected_errors(&said.answers(app, &things)?);
        let of = |need: &&ScanNeed| errors[things.rows_of(need.scan)].iter().fold(0.0, |a, b| a + b);
        needs.iter().map(of).collect()
    };
    let keys = keys(reader, &needs);
    let mut order: Vec<(&ScanNeed, f64, &RadarScanKey)> =
        needs.iter().zip(left).zip(&keys).map(|((need, left), key)| (*need, left, key)).collect();
    order.sort_by(|(a, a_left, a_key), (b, b_left, b_key)| {
        let reviewed = |key: &RadarScanKey| said.holding.get(key).is_some_and(|said| said.reviewed.is_some());
        let by_place = || (a.t_ns, a.scan).cmp(&(b.t_ns, b.scan));
        reviewed(a_key).cmp(&reviewed(b_key)).then(b_left.total_cmp(a_left)).then_with(by_place)
    });
    let scans: Vec<Value> = order.into_iter().map(|(need, left, key)| row(need, left, key, &said)).collect();
    json(&json!({ "scans": scans, "progress": said.progress(&keys) }))
}

fn row(need: &ScanNeed, left: f64, key: &RadarScanKey, said: &Said) -> Value {
    let holding = said.holding.get(key);
    let reviewed = holding.and_then(|said| said.reviewed.as_ref());
    json!({
        "radar": *key.radar,
        "scan": key.scan,
        "t_ns": time(need.t_ns),
        "detections": need.doubts.detections,
        "expected_errors": left,
        "uncertain": need.doubts.uncertain,
        "disagreeing": need.doubts.disagreeing,
        "cameras_failed": need.cameras_failed,
        "corrected": holding.map_or(0, |said| said.corrected),
        "reviewed": reviewed.map(|(author, at)| json!({ "author": author, "at": at })),
        "orphaned": said.orphaned.get(key).copied().unwrap_or(0),
    })
}

/// How far a sequence is.
pub(crate) fn progress(app: &App, sequence: &str) -> Result<Value, ApiError> {
    let (index, reader) = app.sequence(sequence)?;
    let needs = app.labels(index)?.needs(reader)?;
    let keys = keys(reader, &queued(app, reader, &needs));
    Ok(Said::of(app, reader.sequence())?.progress(&keys))
}

fn key(sequence: &Sequence, ScanIndex { radar, scan }: ScanIndex) -> RadarScanKey {
    RadarScanKey::new(&sequence.rig.radars[radar].name, scan)
}

fn keys(reader: &dyn SequenceReader, needs: &[&ScanNeed]) -> Vec<RadarScanKey> {
    needs.iter().map(|need| key(reader.sequence(), need.scan)).collect()
}

/// The scans that the queue is about: all, but for somebody who labels some of them a second time.
fn queued<'a>(app: &App, reader: &dyn SequenceReader, needs: &'a [ScanNeed]) -> Vec<&'a ScanNeed> {
    let asks = app.team.asks(reader.sequence());
    needs.iter().filter(|need| asks(need.scan)).collect()
}
