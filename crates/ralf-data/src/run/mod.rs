//! Labelling a recording: in parallel, in bounded memory, resumable, and the same to the byte whatever the number of jobs.
//!
//! Every scan's label depends on the recording and the settings alone, so that scans may be labelled in any order. Their
//! tables are kept as files of their own until a sequence is complete, and then put together in the order of the rig. A run
//! that was killed finds them again by a fingerprint of program, settings and inputs.

mod assemble;
mod inputs;
mod record;
mod results;
mod workers;
mod workspace;

pub use record::{CameraRecord, ImageRecord, NotLabelled, RadarRecord, RunRecord, SequenceRecord};

use crate::output::Columns;
use crate::{DataError, Recording, SequenceReader, layout};
use ralf::config::Config;
use ralf::rig::Rig;
use std::path::{Path, PathBuf};
use std::time::Instant;
use workspace::{RECORD, Workspace, read_json};

/// The record of the run whose results lie in a folder; `None` where it holds none.
pub fn read_record(out: &Path) -> Result<Option<RunRecord>, DataError> {
    read_json(&out.join(RECORD))
}

/// A labelling run.
pub struct LabelRun<'a> {
    /// What is labelled.
    pub recording: &'a Recording,
    /// With these settings.
    pub config: &'a Config,
    /// Where the results go.
    pub out: &'a Path,
    /// Threads.
    pub jobs: usize,
}

/// Part of a run, for a progress display.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage<'a> {
    /// Hashing the input files; counted in bytes.
    Inputs,
    /// Labelling a sequence; counted in scans.
    Labelling(&'a str),
    /// Writing a sequence's result; counted in scans.
    Writing(&'a str),
}

/// Is told how a run gets on. Called from several threads.
pub trait Observer: Sync {
    /// A stage of so many steps begins.
    fn begin(&self, stage: Stage, steps: u64);
    /// Some more steps of the stage are done, with so many detections in them.
    fn advance(&self, steps: u64, detections: u64);
    /// The stage is over.
    fn end(&self);
}

/// How a run ended.
#[derive(Debug)]
pub enum Outcome {
    /// It was done before, with the same program, settings and inputs.
    Unchanged(RunRecord),
    /// It is done now.
    Labelled(RunRecord),
}

/// One sequence with the sensors as the settings have them.
struct Task<'a> {
    reader: &'a dyn SequenceReader,
    rig: Rig,
    columns: Columns,
}

impl LabelRun<'_> {
    /// Labels every scan of every radar. Scans that can't be labelled are named in the record, and the run goes on; settings
    /// that don't fit the recording, and results that can't be written, end it.
    pub fn execute(&self, observer: &dyn Observer) -> Result<Outcome, DataError> {
        let begun = Instant::now();
        self.refuse_to_write_into_the_recording()?;
        let tasks = self.recording.sequences.iter().map(|reader| self.task(reader.as_ref()));
        let tasks = tasks.collect::<Result<Vec<_>, _>>()?;
        let inputs = inputs::hash_inputs(self.recording, self.jobs, observer)?;
        let mut record = RunRecord::new(self.recording, self.config, inputs);
        let workspace = Workspace::open(self.out, &record)?;
        if let Some(done) = workspace.finished() {
            return Ok(Outcome::Unchanged(done));
        }
        for task in &tasks {
            let sequence = match workspace.finished_sequence(task.reader) {
                Some(done) => done,
                None => self.label_sequence(task, &workspace, observer)?,
            };
            record.sequences.push(sequence);
        }
        record.timings.seconds = begun.elapsed().as_secs_f64();
        record.timings.jobs = self.jobs;
        workspace.finish(&record)?;
        Ok(Outcome::Labelled(record))
    }

    fn task<'a>(&self, reader: &'a dyn SequenceReader) -> Result<Task<'a>, DataError> {
        let sequence = reader.sequence();
        let refused = |expected: String| {
            let place = format!("sequence {}", sequence.name);
            DataError::Unsuitable { file: self.recording.path.clone(), place, reason: expected }
        };
        let mut rig = sequence.rig.clone();
        self.config.apply_to(&mut rig).map_err(|error| refused(error.to_string()))?;
        let columns = Columns::of(&rig).map_err(refused)?;
        Ok(Task { reader, rig, columns })
    }

    fn label_sequence(
        &self,
        task: &Task,
        workspace: &Workspace,
        observer: &dyn Observer,
    ) -> Result<SequenceRecord, DataError> {
        let begun = Instant::now();
        let not_labelled = workers::label_scans(task, self.config, workspace, self.jobs, observer)?;
        let mut record = assemble::assemble(task, workspace, not_labelled, observer)?;
        record.seconds = begun.elapsed().as_secs_f64();
        workspace.finish_sequence(&record)?;
        Ok(record)
    }

    /// Inputs are only read: results beside them would be taken for a part of the recording.
    fn refuse_to_write_into_the_recording(&self) -> Result<(), DataError> {
        let (out, recording) = (real_path(self.out), real_path(&self.recording.path));
        if out != recording && !out.starts_with(recording.join(layout::SEQUENCES)) {
            return Ok(());
        }
        Err(DataError::content(
            self.out,
            "output folder",
            "another folder than the recording's own",
            "a part of the recording",
        ))
    }
}

/// Where a path leads that need not exist yet: links in the part that does exist are resolved.
fn real_path(path: &Path) -> PathBuf {
    match (path.canonicalize(), path.parent(), path.file_name()) {
        (Ok(real), _, _) => real,
        (Err(_), Some(parent), Some(name)) if parent.as_os_str().is_empty() => {
            real_path(Path::new(".")).join(name)
        }
        (Err(_), Some(parent), Some(name)) => real_path(parent).join(name),
        _ => path.to_owned(),
    }
}
