//! Which scan wants a person next.

use super::time;
use crate::app::App;
use crate::http::{Answer, ApiError, json};
use crate::need::ScanNeed;
use ralf_corrections::ScanSummary;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// Every labelled radar scan of a sequence: those that nobody has reviewed first, and of these the most needy.
pub(crate) fn queue(app: &App, sequence: &str) -> Answer {
    let (index, reader) = app.sequence(sequence)?;
    let needs = app.labels(index)?.needs(reader)?;
    let summaries = app.store().summaries(sequence)?;
    let said: BTreeMap<(&str, usize), &ScanSummary> =
        summaries.iter().map(|said| ((said.key.radar.as_str(), said.key.scan as usize), said)).collect();
    let name = |need: &ScanNeed| reader.sequence().rig.radars[need.radar].name.as_str();
    let said = |need: &ScanNeed| said.get(&(name(need), need.scan)).copied();
    let mut order: Vec<&ScanNeed> = needs.iter().collect();
    order.sort_by(|a, b| {
        let reviewed = |need| said(need).is_some_and(|said| said.reviewed.is_some());
        let by_need = b.need().total_cmp(&a.need());
        let by_place = || (a.t_ns, a.radar, a.scan).cmp(&(b.t_ns, b.radar, b.scan));
        reviewed(a).cmp(&reviewed(b)).then(by_need).then_with(by_place)
    });
    let scans: Vec<Value> = order.into_iter().map(|need| row(name(need), need, said(need))).collect();
    json(&json!({ "scans": scans, "progress": count(needs.len(), &summaries) }))
}

fn row(radar: &str, need: &ScanNeed, said: Option<&ScanSummary>) -> Value {
    let reviewed = said.and_then(|said| said.reviewed.as_ref());
    json!({
        "radar": radar,
        "scan": need.scan,
        "t_ns": time(need.t_ns),
        "detections": need.detections,
        "need": need.need(),
        "uncertain": need.uncertain,
        "disagreeing": need.disagreeing,
        "cameras_failed": need.cameras_failed,
        "corrected": said.map_or(0, |said| said.corrected),
        "reviewed": reviewed.map(|(author, at)| json!({ "author": author, "at": at })),
    })
}

/// How far a sequence is.
pub(crate) fn progress(app: &App, sequence: &str) -> Result<Value, ApiError> {
    let (index, reader) = app.sequence(sequence)?;
    let scans = app.labels(index)?.needs(reader)?.len();
    Ok(count(scans, &app.store().summaries(sequence)?))
}

fn count(scans: usize, summaries: &[ScanSummary]) -> Value {
    json!({
        "scans": scans,
        "reviewed": summaries.iter().filter(|said| said.reviewed.is_some()).count(),
        "corrected_detections": summaries.iter().map(|said| said.corrected).sum::<u64>(),
    })
}
