//! Labelling, on one machine and on many, and what it leaves.

use crate::errors::{data, in_file, other};
use crate::table::{Table, table_of};
use crate::watch::watched;
use pyo3::prelude::*;
use ralf_data::many::{self, Job, Task};
use ralf_data::result::{Kind as ColumnKind, LabelledRun};
use ralf_data::run::{Earlier, Outcome, read_record, told_gone};
use ralf_data::views::Lacking;
use ralf_data::{DataError, Settings};
use ralf_files::Kind;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::thread::available_parallelism;

/// As many threads as asked for, or as there are processors.
pub(crate) fn threads(jobs: Option<NonZeroUsize>) -> NonZeroUsize {
    jobs.or_else(|| available_parallelism().ok()).unwrap_or(NonZeroUsize::MIN)
}

pub(crate) fn to_json(value: &impl Serialize) -> PyResult<String> {
    serde_json::to_string(value).map_err(other)
}

pub(crate) fn from_json<T: DeserializeOwned>(text: &str) -> PyResult<T> {
    serde_json::from_str(text).map_err(other)
}

/// A job as Python tells it. Its paths are of whatever bytes; JSON, which tells the rest, has no word for such.
#[derive(FromPyObject)]
pub(crate) struct ToldJob {
    recording: PathBuf,
    out: PathBuf,
    model: Option<PathBuf>,
    depth: Option<PathBuf>,
    segmentation: Option<PathBuf>,
    told: String,
}

/// The rest of a job.
#[derive(Deserialize)]
struct How {
    format: Option<String>,
    sequences: Vec<String>,
    settings: Settings,
    evidence: bool,
    check: bool,
}

impl ToldJob {
    /// The job.
    pub(crate) fn resolve(self) -> PyResult<Job> {
        let Self { recording, out, model, depth, segmentation, told } = self;
        let How { format, sequences, settings, evidence, check } = from_json(&told)?;
        Ok(Job { recording, out, format, sequences, settings, evidence, model, depth, segmentation, check })
    }
}

/// All settings; JSON. Assignments `key=value` win over a TOML file, if any, which wins key by key over all settings
/// `below` it, JSON as this function returns it.
#[pyfunction]
#[pyo3(signature = (file, assignments, below=None))]
pub(crate) fn settings(
    file: Option<PathBuf>,
    assignments: Vec<String>,
    below: Option<&str>,
) -> PyResult<String> {
    let mut texts = Vec::new();
    if let Some(below) = below {
        texts.push(from_json::<Settings>(below)?.to_toml().map_err(other)?);
    }
    if let Some(file) = &file {
        texts.push(read_settings(file)?);
    }
    let text = Settings::joined(&texts).map_err(other)?;
    let assignments: Vec<&str> = assignments.iter().map(String::as_str).collect();
    to_json(&Settings::from_toml(&text, &assignments).map_err(other)?)
}

/// The text of a settings file, which by itself is one: what is wrong with it is said of it.
fn read_settings(file: &Path) -> PyResult<String> {
    let text = ralf_files::read_text(file, Kind::Settings).map_err(DataError::io(file)).map_err(data)?;
    Settings::from_toml(&text, &[]).map_err(|error| in_file(file, error))?;
    Ok(text)
}

/// Labels a recording by a job.
#[pyfunction]
#[pyo3(signature = (job, jobs=None, progress=None))]
pub(crate) fn label(
    py: Python<'_>,
    job: ToldJob,
    jobs: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Done> {
    let job = job.resolve()?;
    let (done, lacking) = watched(py, progress.as_ref(), |watch| job.label_and_tell(threads(jobs), watch))?;
    Ok(told(done, &lacking))
}

/// What was done: the sequences that this call has labelled, those that were asked for, what became of earlier results,
/// and what else there is to be warned of.
type Done = (Vec<String>, Vec<String>, Vec<String>, Vec<String>);

fn told(done: Outcome, lacking: &[Lacking]) -> Done {
    let Outcome { record, labelled, earlier, gone, mut warnings, .. } = done;
    warnings.extend((!gone.is_empty()).then(|| told_gone(&gone)));
    warnings.extend(lacking.iter().map(Lacking::words));
    warnings.extend(
        record.doubtful_radars().map(|(sequence, radar, words)| format!("{sequence} {radar}: {words}")),
    );
    let asked = record.sequences.into_iter().map(|sequence| sequence.name).collect();
    (labelled, asked, earlier.told(Earlier::NOW), warnings)
}

/// The parts of a job, of so many scans at most, JSON each; and what there is to be warned of.
#[pyfunction]
#[pyo3(signature = (job, scans, jobs=None, progress=None))]
pub(crate) fn plan(
    py: Python<'_>,
    job: ToldJob,
    scans: NonZeroUsize,
    jobs: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<String>, Vec<String>)> {
    let job = job.resolve()?;
    let plan = watched(py, progress.as_ref(), |watch| many::plan(&job, scans, threads(jobs), watch))?;
    let tasks = plan.tasks.iter().map(to_json).collect::<PyResult<_>>()?;
    let mut warnings = plan.earlier.told(Earlier::PLANNED);
    warnings.extend(plan.left_out.iter().map(|sequence| format!("left out: {sequence}")));
    warnings.extend(plan.not_copied);
    warnings.extend(plan.lacking.iter().map(Lacking::words));
    Ok((tasks, warnings))
}

/// Does a part of a job. Returns the scans that can't be labelled; JSON.
#[pyfunction]
#[pyo3(signature = (task, jobs=None, progress=None))]
pub(crate) fn label_one(
    py: Python<'_>,
    task: &str,
    jobs: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let task: Task = from_json(task)?;
    let done = watched(py, progress.as_ref(), |watch| many::label_one(&task, threads(jobs), watch))?;
    to_json(&done.not_labelled)
}

/// Puts the parts of a job together.
#[pyfunction]
#[pyo3(signature = (out, jobs=None, progress=None))]
pub(crate) fn assemble(
    py: Python<'_>,
    out: PathBuf,
    jobs: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Done> {
    let done = watched(py, progress.as_ref(), |watch| many::assemble(&out, threads(jobs), watch))?;
    Ok(told(done, &[]))
}

/// The output folders for which something was planned.
#[pyfunction]
pub(crate) fn planned(out: PathBuf) -> PyResult<Vec<PathBuf>> {
    let folders = many::planned(&out).map_err(data)?;
    if folders.is_empty() {
        return Err(data(DataError::content(&out, "plan.json", "what `ralf.plan` wrote", "nothing")));
    }
    Ok(folders)
}

/// A folder in `out` for each recording.
#[pyfunction]
pub(crate) fn folders(recordings: Vec<PathBuf>, out: PathBuf) -> PyResult<Vec<PathBuf>> {
    many::folders(&recordings, &out).map_err(data)
}

/// What `run.json` tells; JSON.
#[pyfunction]
pub(crate) fn record(out: PathBuf) -> PyResult<String> {
    to_json(&read_record(&out).map_err(data)?)
}

/// The names of the columns of numbers that each of these sequences' tables has.
#[pyfunction]
pub(crate) fn columns(out: PathBuf, sequences: Vec<String>) -> PyResult<Vec<Vec<String>>> {
    let run = LabelledRun::open(&out).map_err(data)?;
    let columns = |sequence: &String| {
        let schema = run.whole_columns(sequence)?;
        let numbers = schema
            .columns()
            .iter()
            .filter(|column| !matches!(column.kind, ColumnKind::Text | ColumnKind::Truth));
        Ok(numbers.map(|column| column.name.to_string()).collect())
    };
    sequences.iter().map(columns).collect::<Result<_, _>>().map_err(data)
}

/// The labelled detections of a sequence.
#[pyfunction]
pub(crate) fn table(py: Python<'_>, out: PathBuf, sequence: &str) -> PyResult<Table> {
    let read = || LabelledRun::open(&out)?.whole_table(sequence);
    let reader = py.detach(read).map_err(|error: DataError| data(error))?;
    py.detach(|| table_of(&reader))
}
