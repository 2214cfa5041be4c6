//! Many recordings on many machines: [`plan`] what is to be done, label each part of it anywhere ([`label_one`]), and
//! [`assemble`] the results.
//!
//! Machines share the folders of recordings and results, and nothing else: whatever starts processes can start these
//! three. Each may be done again after it was killed. What is assembled is what one machine would have written, to the
//! byte, but for the timings in `run.json`.

mod tasks;

pub use tasks::{read_task, write_tasks};

use crate::disk::files;
use crate::error::DataError;
use crate::read::open::recognised;
use crate::read::{Recording, open_selected};
use crate::result::json::{read_json, write_json};
use crate::result::{Component, is_under_way};
use crate::run::{
    Earlier, LabelRun, Observer, Outcome, Planned, Stretch, StretchOutcome, check_folder_of_many,
    check_output_folder, read_record,
};
use crate::settings::Settings;
use crate::tree::{PLAN, RECORD};
use crate::views::{Lacking, lacking, with_stored};
use ralf::config::Method;
use ralf::learned::Model;
use ralf_files::Kind;
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// How a recording is labelled, and where to.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Job {
    /// What is labelled.
    pub recording: PathBuf,
    /// Where the results go.
    pub out: PathBuf,
    /// Its format, where it is not to be recognised.
    #[serde(default)]
    pub format: Option<String>,
    /// These sequences alone; all of them if empty.
    #[serde(default)]
    pub sequences: Vec<String>,
    /// With these settings.
    #[serde(default)]
    pub settings: Settings,
    /// Whether evidence is gathered, too.
    #[serde(default)]
    pub evidence: bool,
    /// The file of the model that answers where the method is the learned one; the shipped one if there is none.
    #[serde(default)]
    pub model: Option<PathBuf>,
    /// A folder of depth images, as `ralf depth` wrote them.
    #[serde(default)]
    pub depth: Option<PathBuf>,
    /// A folder of segmentations, as `ralf segment` wrote them.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub segmentation: Option<PathBuf>,
    /// Whether the record tells what a check says of the recording.
    #[serde(default)]
    pub check: bool,
}

/// Part of a job that one machine does by itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Task {
    /// The whole.
    pub job: Job,
    /// Which part.
    pub stretch: Stretch,
}

/// What is to be done of a job, and what to know before.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Plan {
    /// Its parts that are not done yet.
    pub tasks: Vec<Task>,
    /// What became of results that lay in the output folder.
    pub earlier: Earlier,
    /// What [`Recording::left_out`] says.
    pub left_out: Vec<String>,
    /// What [`Recording::told_not_copied`] says.
    pub not_copied: Option<String>,
    /// Cameras of whose images the stores hold some, and not all that labelling asks for.
    pub lacking: Vec<Lacking>,
}

impl Job {
    /// A recording as `ralf label RECORDING -o OUT` labels it.
    pub fn new(recording: &Path, out: &Path) -> Self {
        Self {
            recording: recording.to_owned(),
            out: out.to_owned(),
            format: None,
            sequences: Vec::new(),
            settings: Settings::default(),
            evidence: false,
            model: None,
            depth: None,
            segmentation: None,
            check: true,
        }
    }

    /// Opens the recording, as the settings correct it, without the sequences that it [leaves
    /// out](Recording::left_out) and, where none is named, those that weren't [copied](Recording::copied).
    ///
    /// # Errors
    /// What can't be read, and sequences that aren't there.
    pub fn open(&self) -> Result<Recording, DataError> {
        let (format, topics) = (self.format.as_deref(), &self.settings.topics);
        let recording = open_selected(&self.recording, format, topics, &self.sequences)?;
        let recording = self.settings.correct(recording.copied())?;
        with_stored(recording, self.depth.as_deref(), self.segmentation.as_deref())
    }

    /// Labels the recording, on this machine alone.
    ///
    /// # Errors
    /// Those of [`LabelRun::execute`] and [`Self::open`].
    pub fn label(&self, jobs: NonZeroUsize, observer: &dyn Observer) -> Result<Outcome, DataError> {
        self.with_run(jobs, |run| self.execute(run, observer))
    }

    /// The same, and of which cameras the stores hold some images, and not all.
    ///
    /// # Errors
    /// Those of [`Self::label`].
    pub fn label_and_tell(
        &self,
        jobs: NonZeroUsize,
        observer: &dyn Observer,
    ) -> Result<(Outcome, Vec<Lacking>), DataError> {
        self.with_run(jobs, |run| {
            let lacking = self.lacking(run)?;
            Ok((self.execute(run, observer)?, lacking))
        })
    }

    /// What labels a recording as this job says: the job's own, or one in memory.
    pub fn run<'a>(
        &'a self,
        recording: &'a Recording,
        model: Option<&'a Model>,
        jobs: NonZeroUsize,
    ) -> LabelRun<'a> {
        LabelRun {
            recording,
            settings: &self.settings,
            out: &self.out,
            jobs: jobs.get(),
            checks: &[],
            evidence: self.evidence,
            model,
        }
    }

    fn execute(&self, run: &LabelRun, observer: &dyn Observer) -> Result<Outcome, DataError> {
        match self.check {
            true => run.execute_and_check(observer, &|_| {}),
            false => run.execute(observer),
        }
    }

    fn lacking(&self, run: &LabelRun) -> Result<Vec<Lacking>, DataError> {
        lacking(run.recording, self.depth.as_deref(), self.segmentation.as_deref(), &run.settings.method)
    }

    /// The same, with paths that lead to the same places from every folder.
    fn anywhere(&self) -> Self {
        let further = |path: &Option<PathBuf>| path.as_deref().map(files::whole);
        Self {
            recording: files::whole(&self.recording),
            out: files::whole(&self.out),
            settings: self.settings.anywhere(),
            model: further(&self.model),
            depth: further(&self.depth),
            segmentation: further(&self.segmentation),
            ..self.clone()
        }
    }

    fn with_run<T>(
        &self,
        jobs: NonZeroUsize,
        work: impl FnOnce(&LabelRun) -> Result<T, DataError>,
    ) -> Result<T, DataError> {
        let recording = self.open()?;
        let model = self.model()?;
        work(&self.run(&recording, model.as_ref(), jobs))
    }

    fn model(&self) -> Result<Option<Model>, DataError> {
        model_of(self.settings.method.method, self.model.as_deref())
    }
}

/// The model that answers with a method: a file's, or the shipped one; `None` where none is asked.
///
/// # Errors
/// A file that can't be read or holds no model that this version can use, and a file for the method that asks none.
pub fn model_of(method: Method, file: Option<&Path>) -> Result<Option<Model>, DataError> {
    match (method, file) {
        (Method::Paper, None) => Ok(None),
        (Method::Paper, Some(file)) => {
            let expected = "the method that asks a model (method = \"learned\")";
            Err(DataError::content(file, "model", expected, "the paper's"))
        }
        (Method::Learned, file) => read_model(file).map(Some),
    }
}

fn read_model(file: Option<&Path>) -> Result<Model, DataError> {
    let refused = |reason: String| DataError::Unsuitable {
        file: file.unwrap_or(Path::new("the shipped model")).to_owned(),
        place: "model".to_owned(),
        reason,
    };
    let Some(path) = file else { return Model::shipped().map_err(|error| refused(error.to_string())) };
    let model = Model::from_text(&files::read_text(path, Kind::Settings)?);
    let model = model.map_err(|error| refused(error.to_string()))?;
    model.check().map_err(|error| refused(error.to_string()))?;
    Ok(model)
}

/// The parts of a job that are not done yet, of so many scans at most. They say where everything lies, so that any
/// machine that sees the same folders can do them, in any order.
///
/// # Errors
/// What [`LabelRun::plan`] refuses. [`assemble`] names the recording again, unless the folder has an earlier plan,
/// which stays, as it does where others are at work on it, or labels that nobody planned. Of what is no recording
/// nothing is left.
pub fn plan(
    job: &Job,
    scans: NonZeroUsize,
    jobs: NonZeroUsize,
    observer: &dyn Observer,
) -> Result<Plan, DataError> {
    let job = job.anywhere();
    check_output_folder(&job.recording, &job.out)?;
    let file = job.out.join(PLAN);
    let keep = || write_json(&file, &job);
    let planned = job.with_run(jobs, |run| {
        let (left_out, lacking) = (run.recording.left_out(), job.lacking(run)?);
        let not_copied = run.recording.told_not_copied();
        let Planned { stretches, earlier } = run.plan_and(keep, scans, observer)?;
        let tasks = stretches.into_iter().map(|stretch| Task { job: job.clone(), stretch }).collect();
        Ok(Plan { tasks, earlier, left_out, not_copied, lacking })
    });
    let has_no = |file: &Path| files::exists(file).map(|exists| !exists);
    if planned.is_err() && is_recording(&job) && has_no(&file)? && has_no(&job.out.join(RECORD))? {
        keep()?;
    }
    planned
}

/// Whether there is a recording, though it may be damaged.
fn is_recording(Job { recording, format, .. }: &Job) -> bool {
    format.as_ref().map_or_else(|| recognised(recording).is_some(), |_| recording.exists())
}

/// Does a part of a job. Tells which scans can't be labelled, and what others were labelled without.
///
/// # Errors
/// What [`LabelRun::label_stretch`] refuses.
pub fn label_one(
    task: &Task,
    jobs: NonZeroUsize,
    observer: &dyn Observer,
) -> Result<StretchOutcome, DataError> {
    task.job.with_run(jobs, |run| run.label_stretch(&task.stretch, observer))
}

/// The output folders in `out` for which something was planned: `out` itself, or folders in it.
///
/// # Errors
/// A folder that can't be read.
pub fn planned(out: &Path) -> Result<Vec<PathBuf>, DataError> {
    if files::exists(&out.join(PLAN))? {
        return Ok(vec![out.to_owned()]);
    }
    let folders = files::folders(out)?.into_iter().map(|name| out.join(name));
    Ok(folders.filter(|folder| folder.join(PLAN).exists()).collect())
}

/// Puts the parts of a job together that was planned for this folder. Scans that nobody has labelled are labelled now.
/// Of a recording that is gone after all was labelled the labels stay ([`Outcome::gone`]).
///
/// # Errors
/// A folder that nothing was planned for, and those of [`Job::label`].
pub fn assemble(out: &Path, jobs: NonZeroUsize, observer: &dyn Observer) -> Result<Outcome, DataError> {
    let job: Job = read_json(&out.join(PLAN))?;
    if !files::exists(&job.recording)? && files::exists(&out.join(RECORD))? && !is_under_way(out)? {
        let record = read_record(out)?;
        let gone = record.sequences.iter().map(|sequence| sequence.name.clone()).collect();
        let (labelled, left_out, warnings) = Default::default();
        return Ok(Outcome { record, labelled, earlier: Earlier::default(), left_out, gone, warnings });
    }
    // The folder may have another name on this machine.
    Job { out: out.to_owned(), ..job }.label(jobs, observer)
}

/// A folder in `out` for each recording, by the last part of its path.
///
/// # Errors
/// A name that no folder can have, or that two of them have; and an `out` that is a recording, or lies in one or among
/// results.
pub fn folders(recordings: &[PathBuf], out: &Path) -> Result<Vec<PathBuf>, DataError> {
    check_folder_of_many(out)?;
    let mut found: Vec<PathBuf> = Vec::new();
    for recording in recordings {
        // `.` and `..` have the name of the folder that they lead to.
        let whole = match recording.file_name() {
            Some(_) => recording.clone(),
            None => recording.canonicalize().map_err(DataError::io(recording))?,
        };
        let name = whole.file_name().unwrap_or_default().to_string_lossy();
        let refused = |found| DataError::Name { kind: "recording".into(), name: name.to_string(), found };
        let folder = out.join(Component::new(&name).map_err(refused)?.as_str());
        if let Some(before) = found.iter().position(|known| *known == folder) {
            let expected = format!("names of recordings that differ, for {name} is to be the folder of one");
            let [one, other] = [&recordings[before], recording].map(|path| path.display().to_string());
            return Err(DataError::content(out, "folder", expected, format!("{one} and {other}")));
        }
        found.push(folder);
    }
    Ok(found)
}
