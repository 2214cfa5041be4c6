//! What people say of a sequence, scan by scan.

use crate::app::App;
use crate::http::ApiError;
use ralf::label::truth_of;
use ralf::sensors::Sequence;
use ralf_corrections::{ScanSummary, ScanVersion};
use ralf_data::Label;
use ralf_data::result::RadarScanKey;
use ralf_data::things::{Answer, SequenceThings};
use ralf_data::truth::effective_labels;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// What people say of a sequence.
#[derive(Default)]
pub(super) struct Said {
    /// Of what the scan holds now.
    pub(super) holding: BTreeMap<RadarScanKey, ScanSummary>,
    /// Corrected detections and marks of what it held before. They are kept, and count nowhere.
    pub(super) orphaned: BTreeMap<RadarScanKey, u64>,
}

impl Said {
    pub(super) fn of(app: &App, sequence: &Sequence) -> Result<Self, ApiError> {
        let mut said = Self::default();
        for summary in app.said(|store| store.summaries(&sequence.name))? {
            let key = RadarScanKey::new(&summary.key.radar, summary.key.scan as usize);
            if app.holds(&summary.key, summary.content)? {
                said.holding.insert(key, summary);
            } else {
                *said.orphaned.entry(key).or_default() +=
                    summary.corrected + u64::from(summary.reviewed.is_some());
            }
        }
        Ok(said)
    }

    /// How far these scans are, and what is corrected of all.
    pub(super) fn progress(&self, scans: &[RadarScanKey]) -> Value {
        let is_reviewed =
            |scan: &&RadarScanKey| self.holding.get(*scan).is_some_and(|said| said.reviewed.is_some());
        json!({
            "scans": scans.len(),
            "reviewed": scans.iter().filter(is_reviewed).count(),
            "corrected_detections": self.holding.values().map(|said| said.corrected).sum::<u64>(),
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
            let Some(content) = app.known_content(&place)? else { continue };
            let rows = things.rows_of(place.scan);
            let said = app.said(|store| store.scan(&ScanVersion { key: place.key, content }))?;
            let accepted = said.review.as_ref().map(|mark| mark.accepted.as_slice());
            let labels = effective_labels(vec![Label::default(); rows.len()], accepted, &said.corrections);
            for (row, label) in rows.zip(labels) {
                let right = things.sightings()[row].plausible;
                let judged = |truth| if truth == right { Answer::Right } else { Answer::Wrong };
                answers[row] = truth_of(label.id).map(judged);
            }
        }
        Ok(answers)
    }
}
