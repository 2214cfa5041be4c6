//! Which scan wants a person next.

use super::time;
use crate::app::App;
use crate::http::{Answer, ApiError, json};
use crate::need::ScanNeed;
use ralf_corrections::ScanSummary;
use ralf_data::SequenceReader;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// What people say of a sequence.
#[derive(Default)]
struct Said {
    /// By radar and scan: of what the scan holds now.
    holding: BTreeMap<(String, usize), ScanSummary>,
    /// By radar and scan: corrected detections and marks of what it held before. They are kept, and count nowhere.
    orphaned: BTreeMap<(String, usize), u64>,
}

impl Said {
    fn of(app: &App, index: usize, reader: &dyn SequenceReader) -> Result<Self, ApiError> {
        let sequence = reader.sequence();
        let mut said = Self::default();
        for summary in app.said(|store| store.summaries(&sequence.name))? {
            let scan = summary.key.scan as usize;
            let radar = sequence.rig.radars.iter().position(|radar| radar.name == summary.key.radar);
            let there = radar.filter(|radar| scan < sequence.times.radars[*radar].len());
            let key = (summary.key.radar.clone(), scan);
            if app.contents.holds(reader, there.map(|radar| (index, radar, scan)), &summary) {
                said.holding.insert(key, summary);
            } else {
                *said.orphaned.entry(key).or_default() +=
                    summary.corrected + u64::from(summary.reviewed.is_some());
            }
        }
        Ok(said)
    }

    fn progress(&self, scans: usize) -> Value {
        let holding = || self.holding.values();
        json!({
            "scans": scans,
            "reviewed": holding().filter(|said| said.reviewed.is_some()).count(),
            "corrected_detections": holding().map(|said| said.corrected).sum::<u64>(),
            "orphaned_scans": self.orphaned.len(),
        })
    }
}

/// Every labelled radar scan of a sequence: those that nobody has reviewed first, and of these the most needy.
pub(crate) fn queue(app: &App, sequence: &str) -> Answer {
    let (index, reader) = app.sequence(sequence)?;
    let needs = app.labels(index)?.needs(reader)?;
    let said = Said::of(app, index, reader)?;
    let key = |need: &ScanNeed| (reader.sequence().rig.radars[need.radar].name.clone(), need.scan);
    let mut order: Vec<(&ScanNeed, (String, usize))> = needs.iter().map(|need| (need, key(need))).collect();
    order.sort_by(|(a, a_key), (b, b_key)| {
        let reviewed = |key| said.holding.get(key).is_some_and(|said| said.reviewed.is_some());
        let by_need = b.need().total_cmp(&a.need());
        let by_place = || (a.t_ns, a.radar, a.scan).cmp(&(b.t_ns, b.radar, b.scan));
        reviewed(a_key).cmp(&reviewed(b_key)).then(by_need).then_with(by_place)
    });
    let scans: Vec<Value> = order.into_iter().map(|(need, key)| row(need, &key, &said)).collect();
    json(&json!({ "scans": scans, "progress": said.progress(needs.len()) }))
}

fn row(need: &ScanNeed, key: &(String, usize), said: &Said) -> Value {
    let holding = said.holding.get(key);
    let reviewed = holding.and_then(|said| said.reviewed.as_ref());
    json!({
        "radar": key.0,
        "scan": need.scan,
        "t_ns": time(need.t_ns),
        "detections": need.doubts.detections,
        "need": need.need(),
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
    let scans = app.labels(index)?.needs(reader)?.len();
    Ok(Said::of(app, index, reader)?.progress(scans))
}
