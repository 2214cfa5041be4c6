//! How good labels are.

use crate::errors::data;
use crate::labelling::to_json;
use pyo3::prelude::*;

use ralf_data::result::LabelledRun;
use ralf_data::{Balances, Comparison, Corrections, DataError, GroundTruth, open_with};
use std::path::{Path, PathBuf};

/// As `ralf evaluate OUT --truth TRUTH --json` prints it; without a truth how balanced the labels are.
#[pyfunction]
#[pyo3(signature = (out, truth=None))]
pub(crate) fn evaluate(py: Python<'_>, out: PathBuf, truth: Option<PathBuf>) -> PyResult<String> {
    match truth {
        Some(truth) => to_json(&py.detach(|| compare(&out, &truth)).map_err(data)?.evaluation()),
        None => to_json(&py.detach(|| Balances::of_run(&out)).map_err(data)?),
    }
}

/// Against the truth of a dataset, with what people corrected above it.
fn compare(out: &Path, dataset: &Path) -> Result<Comparison, DataError> {
    let run = LabelledRun::open(out)?;
    let recording = open_with(dataset, None, &run.settings().topics).ok();
    // Labels of one format may be compared with truth that is kept in another.
    let recording = recording.filter(|recording| recording.format == run.record().format);
    let corrections = match recording {
        Some(mut recording) => {
            recording.sequences.retain(|reader| run.holds(&reader.sequence().name));
            run.refuse_changes(&recording)?;
            Corrections::of_recording(out, &recording)?
        }
        None => Corrections::open(out)?,
    };
    let truth = match corrections.is_empty() {
        true => GroundTruth::open(dataset)?,
        false => GroundTruth::merged(dataset, corrections)?,
    };
    Comparison::new(out, &truth)
}
