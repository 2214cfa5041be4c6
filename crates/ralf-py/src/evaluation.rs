//! How good labels are.

use crate::arrays::Column;
use crate::errors::data;
use crate::labelling::to_json;
use arrow_buffer::Buffer;
use pyo3::prelude::*;
use ralf::label::truth_of;
use ralf::metrics::Evaluation;
use ralf_data::result::labelled_recording;
use ralf_data::run::read_record;
use ralf_data::{
    Balances, Comparison, Corrections, DataError, GroundTruth, Recording, ScanId, lost_sequences,
};
use ralf_report::listed;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// So many sequences are named that labels were not made of, or that are gone.
const SHOWN: usize = 5;

/// As `ralf evaluate OUT --truth TRUTH --json` prints it, and a sentence for each scan whose corrections don't count;
/// without a truth how balanced the labels are.
#[pyfunction]
#[pyo3(signature = (out, truth=None))]
pub(crate) fn evaluate(
    py: Python<'_>,
    out: PathBuf,
    truth: Option<PathBuf>,
) -> PyResult<(String, Vec<String>)> {
    let Some(truth) = truth else {
        return Ok((to_json(&py.detach(|| Balances::of_run(&out)).map_err(data)?)?, Vec::new()));
    };
    let (evaluation, orphaned) = py.detach(|| compare(&out, &truth)).map_err(data)?;
    Ok((to_json(&evaluation)?, orphaned))
}

/// Whether people said something of a run's labels, of these sequences and radars; of all radars where none is named.
/// Of a store that can't be read nobody knows who doesn't ask for it.
#[pyfunction]
pub(crate) fn is_corrected(out: PathBuf, sequences: Vec<String>, radars: Option<Vec<String>>) -> bool {
    let is_chosen = |scan: &ScanId| {
        sequences.contains(&scan.sequence)
            && radars.as_ref().is_none_or(|radars| radars.contains(&scan.radar))
    };
    Corrections::open(&out).is_ok_and(|corrections| !corrections.of_scans(is_chosen).is_empty())
}

/// Against the truth of a dataset, with what people corrected above it.
fn compare(out: &Path, dataset: &Path) -> Result<(Evaluation, Vec<String>), DataError> {
    let (truth, orphaned) = corrected(out, dataset)?;
    Ok((Comparison::new(out, &truth)?.evaluation_of(out, &truth)?, orphaned))
}

/// The truth of a dataset, with what people corrected of a run above it, and a sentence for each scan whose corrections
/// don't count.
fn corrected(out: &Path, dataset: &Path) -> Result<(GroundTruth, Vec<String>), DataError> {
    let corrections = match labelled_recording(out, dataset)? {
        Some((run, recording)) => {
            refuse_lost_sequences(out, &recording)?;
            run.refuse_changes(&recording)?;
            Corrections::of_recording(out, &recording)?
        }
        None => Corrections::open(out)?,
    };
    let orphaned = corrections.told_orphaned();
    Ok((GroundTruth::merged(dataset, corrections)?, orphaned))
}

/// Refuses truth that says nothing of what was labelled: all would be unknown.
fn refuse_another(out: &Path, dataset: &Path, truth: GroundTruth) -> Result<GroundTruth, DataError> {
    if truth.scans().iter().any(|scan| scan.label_file(out).exists()) {
        return Ok(truth);
    }
    let sequences: BTreeSet<&str> = truth.scans().iter().map(|scan| scan.sequence.as_str()).collect();
    let found = format!("truth of {} alone", listed(&Vec::from_iter(sequences), SHOWN));
    let expected = format!("truth of scans that {} has labels of", out.display());
    Err(DataError::content(dataset, "truth", expected, found))
}

/// Corrections of sequences that are gone would be left out.
fn refuse_lost_sequences(out: &Path, recording: &Recording) -> Result<(), DataError> {
    let lost = lost_sequences(out, None, recording)?;
    if lost.is_empty() {
        return Ok(());
    }
    let names: Vec<&str> = lost.iter().map(String::as_str).collect();
    let found = format!("none of {}", listed(&names, SHOWN));
    Err(DataError::content(&recording.path, "sequences", "all that were corrected", found))
}

/// What is true of a dataset's detections, as far as anybody says it.
#[pyclass(frozen, module = "ralf._ralf")]
pub(crate) struct Truth {
    truth: GroundTruth,
    /// The names of the dataset's sequences, and of those that were labelled.
    sequences: BTreeSet<String>,
    /// A sentence for each scan whose corrections don't count.
    #[pyo3(get)]
    orphaned: Vec<String>,
}

#[pymethods]
impl Truth {
    /// The truth of a dataset, with what people corrected of a run above it.
    #[new]
    #[pyo3(signature = (dataset, out=None))]
    fn new(py: Python<'_>, dataset: PathBuf, out: Option<PathBuf>) -> PyResult<Self> {
        let open = || match &out {
            Some(out) => {
                let (truth, orphaned) = corrected(out, &dataset)?;
                Ok((refuse_another(out, &dataset, truth)?, orphaned))
            }
            None => Ok((GroundTruth::open(&dataset)?, Vec::new())),
        };
        let (truth, orphaned) = py.detach(open).map_err(data)?;
        let mut sequences = truth.sequences().map_err(data)?;
        // Label files alone have no record.
        if let Some(Ok(record)) = out.as_deref().map(read_record) {
            sequences.extend(record.sequences.into_iter().map(|sequence| sequence.name));
        }
        Ok(Self { truth, sequences, orphaned })
    }

    /// Of each detection of a scan 1 plausible, 0 artifact, -1 unknown; `None` where nothing is known of the scan. A
    /// sequence that isn't there is an error.
    fn labels(&self, py: Python<'_>, sequence: String, radar: String, scan: u32) -> PyResult<Option<Column>> {
        if !self.sequences.contains(&sequence) {
            let known = Vec::from_iter(self.sequences.iter().map(String::as_str)).join(", ");
            return Err(data(DataError::UnknownSequence { name: sequence, known }));
        }
        let scan = ScanId { sequence, radar, scan };
        if self.truth.scans().binary_search(&scan).is_err() {
            return Ok(None);
        }
        let labels = py.detach(|| self.truth.labels(&scan)).map_err(data)?;
        let told: Vec<i8> = labels.iter().map(|label| truth_of(label.id).map_or(-1, i8::from)).collect();
        let rows = told.len();
        Ok(Some(Column::new(Buffer::from_vec(told), "|i1", rows, 1)))
    }
}
