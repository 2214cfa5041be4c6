//! Truth that a recording's own files hold beside its detections, in formats that have such.

use super::scan_id::ScanId;
use crate::error::DataError;
use crate::frames::ScanIndex;
use crate::read::open::{open, recognised};
use crate::read::{Recording, SequenceReader, TruthLabels};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A recording whose readers know what is true.
#[derive(Debug, Clone)]
pub(super) struct KnownTruth(Arc<Recording>);

impl KnownTruth {
    /// Opens a dataset of a format that has truth; `None` of any other.
    pub(super) fn find(dataset: &Path) -> Result<Option<Self>, DataError> {
        if !recognised(dataset).is_some_and(|(_, knows_truth)| knows_truth) {
            return Ok(None);
        }
        Ok(Some(Self(Arc::new(open(dataset, None)?))))
    }

    /// All scans, in order: formats that have truth have it of each.
    pub(super) fn scans(&self) -> Vec<ScanId> {
        let mut scans = Vec::new();
        for reader in &self.0.sequences {
            let sequence = reader.sequence();
            for (radar, times) in sequence.rig.radars.iter().zip(&sequence.times.radars) {
                let id = |scan| ScanId { sequence: sequence.name.clone(), radar: radar.name.clone(), scan };
                scans.extend((0..times.len() as u32).map(id));
            }
        }
        scans.sort_unstable();
        scans
    }

    /// The names of all sequences.
    pub(super) fn sequences(&self) -> Vec<String> {
        self.0.sequences.iter().map(|reader| reader.sequence().name.clone()).collect()
    }

    /// What is true of a scan's detections; `None` of a scan that the recording doesn't have.
    pub(super) fn of_scan(&self, scan: &ScanId) -> Result<Option<TruthLabels>, DataError> {
        let Some(reader) = self.reader(&scan.sequence) else { return Ok(None) };
        let place = scan.place_in(reader.sequence());
        place.map_or(Ok(None), |at| truth(reader, at))
    }

    /// The names of a sequence's causes, by their numbers; empty where none are told apart.
    pub(super) fn causes(&self, sequence: &str) -> Vec<String> {
        let causes = self.reader(sequence).map_or(&[][..], SequenceReader::causes);
        causes.iter().map(|cause| cause.name().to_owned()).collect()
    }

    /// The file that a sequence's truth is read from.
    pub(super) fn file(&self, sequence: &str) -> PathBuf {
        let first = self.reader(sequence).and_then(|reader| reader.inputs().into_iter().next());
        first.unwrap_or_else(|| self.0.path.clone())
    }

    fn reader(&self, sequence: &str) -> Option<&dyn SequenceReader> {
        let mut readers = self.0.sequences.iter().map(AsRef::as_ref);
        readers.find(|reader| reader.sequence().name == sequence)
    }
}

fn truth(
    reader: &dyn SequenceReader,
    ScanIndex { radar, scan }: ScanIndex,
) -> Result<Option<TruthLabels>, DataError> {
    reader.truth(radar, scan).map_err(|error| {
        let sensor = reader.sequence().rig.radars[radar].name.clone();
        DataError::Measurement { sensor, index: scan, error }
    })
}
