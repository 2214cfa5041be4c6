//! What people say of a sequence, scan by scan.

use crate::app::App;
use crate::http::ApiError;
use ralf::label::truth_of;
use ralf_corrections::ScanSummary;
use ralf_data::SequenceReader;
use ralf_data::things::{Answer, SequenceThings};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// What people say of a sequence.
#[derive(Default)]
pub(super) struct Said {
    /// By radar and scan: of what the scan holds now.
    pub(super) holding: BTreeMap<(String, usize), ScanSummary>,
    /// By radar and scan: corrected detections and marks of what it held before. They are kept, and count nowhere.
    pub(super) orphaned: BTreeMap<(String, usize), u64>,
}

impl Said {
    pub(super) fn of(app: &App, index: usize, reader: &dyn SequenceReader) -> Result<Self, ApiError> {
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

    pub(super) fn progress(&self, scans: usize) -> Value {
        let holding = || self.holding.values();
        json!({
            "scans": scans,
            "reviewed": holding().filter(|said| said.reviewed.is_some()).count(),
            "corrected_detections": holding().map(|said| said.corrected).sum::<u64>(),
            "orphaned_scans": self.orphaned.len(),
        })
    }

    /// What is said of each detection of the sequence, in the order of its things.
    pub(super) fn answers(
        &self,
        app: &App,
        things: &SequenceThings,
    ) -> Result<Vec<Option<Answer>>, ApiError> {
        let mut answers = vec![None; things.things().len()];
        for summary in self.holding.values() {
            let key = &summary.key;
            let place = app.scan(&key.sequence, &key.radar, key.scan as usize)?;
            let version = app.version(&place)?;
            let said = app.said(|store| store.scan(&version))?;
            let rows = things.rows_of(place.radar, place.scan);
            let of_scan = rows.clone().zip(&mut answers[rows]);
            let corrections: BTreeMap<u32, u16> = said.corrections.into_iter().collect();
            let accepted = said.review.map(|mark| mark.accepted).unwrap_or_default();
            for (point, (row, answer)) in of_scan.enumerate() {
                let id = corrections.get(&(point as u32)).or(accepted.get(point)).copied();
                let right = things.sightings()[row].plausible;
                *answer = id
                    .and_then(truth_of)
                    .map(|truth| if truth == right { Answer::Right } else { Answer::Wrong });
            }
        }
        Ok(answers)
    }
}
