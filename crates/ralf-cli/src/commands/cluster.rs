//! `ralf cluster`: many recordings on many machines, by three steps that anything can start.

use crate::arguments::{MethodArgs, STORED_CLASSES, STORED_DEPTH, SettingsArgs, check_trajectory, threads};
use crate::outcome::{Outcome, say_left_out};
use crate::progress::{Stages, say};
use crate::run_summary::{all_labelled_without, labelled_without, not_labelled, say_gone, say_lacking};
use crate::text::{grouped, in_a_line, print};
use anyhow::{Context, bail};
use clap::{Args, Subcommand};
use ralf_data::Settings;
use ralf_data::many::{self, Job};
use ralf_data::run::Earlier;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// What `ralf cluster` takes.
#[derive(Debug, Args)]
#[command(after_help = "\
Machines share the folders of recordings and results, and nothing else. Every step may be done again, and every task \
twice or by two machines at once; what is done is left alone. The results are those of `ralf label` on one machine, to \
the byte (docs/cluster.md).

Examples:
  ralf cluster plan drives/* -o out               a folder per recording in OUT; prints how many tasks there are
  ralf cluster label out --task 17                one of them, anywhere, by its number from 0
  ralf cluster assemble out                       tables and run.json of each recording

With Slurm:
  n=$(ralf cluster plan drives/* -o out)
  [ \"${n:-0}\" = 0 ] || sbatch --wait --array=0-$((n - 1)) --wrap 'ralf cluster label out --task $SLURM_ARRAY_TASK_ID'
  ralf cluster assemble out")]
pub(crate) struct ClusterArgs {
    #[command(subcommand)]
    step: Step,
}

#[derive(Debug, Subcommand)]
enum Step {
    /// Find out what is to be done, and write it down in OUT
    Plan(Box<PlanArgs>),
    /// Do one task
    Label(TaskArgs),
    /// Put together what tasks have labelled
    Assemble(AssembleArgs),
}

#[derive(Debug, Args)]
#[command(after_help = "\
What OUT holds of these recordings with other settings is removed, and this is said. Tasks of other recordings stay as \
they are, under the same numbers.

Examples:
  ralf cluster plan drives/* -o out                        prints how many tasks there are; 0 where all is done
  ralf cluster plan drives/* -o out --scans 500            smaller tasks
  ralf cluster plan drives/* -o out --method learned --set fusion.threshold=0.5")]
struct PlanArgs {
    /// The recordings
    #[arg(required = true, value_name = "DATASET")]
    recordings: Vec<PathBuf>,
    /// Folder for the results: one in it for each recording
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    settings: SettingsArgs,
    #[command(flatten)]
    method: MethodArgs,
    #[arg(long, value_name = "FOLDER", help = STORED_DEPTH)]
    depth: Option<PathBuf>,
    #[arg(long, value_name = "FOLDER", help = STORED_CLASSES)]
    segmentation: Option<PathBuf>,
    /// Gather what else is known of each detection (docs/evidence.md)
    #[arg(long)]
    evidence: bool,
    /// Leave out the check of the recordings
    #[arg(long)]
    no_check: bool,
    /// Radar scans of a task
    #[arg(long, value_name = "N", default_value = "2048")]
    scans: NonZeroUsize,
    /// Files that are read side by side
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
}

#[derive(Debug, Args)]
#[command(after_help = "\
Examples:
  ralf cluster label out --task 17
  ralf cluster label out --task $SLURM_ARRAY_TASK_ID --jobs 4
  seq 0 $((n - 1)) | parallel ralf cluster label out --task")]
struct TaskArgs {
    /// The folder that was planned
    out: PathBuf,
    /// The task's number, from 0
    #[arg(long, value_name = "N")]
    task: usize,
    /// Scans side by side
    #[arg(long, value_name = "N", default_value = "1")]
    jobs: NonZeroUsize,
}

#[derive(Debug, Args)]
#[command(after_help = "\
What no task has labelled is labelled now. Exit code 3 where some scans can't be.

Examples:
  ralf cluster assemble out
  ralf cluster assemble out --jobs 8 -q")]
struct AssembleArgs {
    /// The folder that was planned
    out: PathBuf,
    /// Scans side by side, of those that nobody has labelled
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
}

/// Does a step.
pub(crate) fn run(arguments: &ClusterArgs) -> anyhow::Result<Outcome> {
    match &arguments.step {
        Step::Plan(arguments) => plan(arguments),
        Step::Label(arguments) => label(arguments),
        Step::Assemble(arguments) => assemble(arguments),
    }
}

/// A recording that can't be planned is named, and costs the others nothing.
fn plan(arguments: &PlanArgs) -> anyhow::Result<Outcome> {
    let mut settings = arguments.settings.resolve()?;
    arguments.method.apply(&mut settings.method, &arguments.settings)?;
    check_trajectory(&settings, arguments.recordings.len())?;
    let (mut planned, mut outcome) = (Vec::new(), Outcome::Done);
    let folders = many::folders(&arguments.recordings, &arguments.output)?;
    for (recording, out) in arguments.recordings.iter().zip(&folders) {
        let jobs = NonZeroUsize::new(threads(arguments.jobs)).unwrap_or(NonZeroUsize::MIN);
        match many::plan(&arguments.job(recording, out, &settings), arguments.scans, jobs, &Stages::default())
        {
            Ok(plan) => {
                let what = plan.earlier.told(Earlier::PLANNED);
                what.iter().for_each(|line| say(&format!("{}: {line}", out.display())));
                say_sequences_left_out(recording, &plan.left_out);
                let not_copied = plan.not_copied.iter();
                not_copied.for_each(|line| say(&format!("warning: {}: {line}", recording.display())));
                say_lacking(&plan.lacking);
                planned.push((out.as_path(), plan.tasks));
            }
            Err(error) => {
                say(&format!("not planned: {}: {error}", recording.display()));
                outcome = Outcome::Partial;
            }
        }
    }
    print(&many::write_tasks(&arguments.output, &planned)?.to_string())?;
    Ok(outcome)
}

/// Names the sequences of a recording that can't be read: the others are labelled all the same.
fn say_sequences_left_out(recording: &Path, left_out: &[String]) {
    for sequence in left_out {
        say_left_out(&format!("{}: {}", recording.display(), in_a_line(sequence)));
    }
}

impl PlanArgs {
    fn job(&self, recording: &Path, out: &Path, settings: &Settings) -> Job {
        Job {
            settings: settings.clone(),
            evidence: self.evidence,
            model: self.method.model.clone(),
            depth: self.depth.clone(),
            segmentation: self.segmentation.clone(),
            check: !self.no_check,
            ..Job::new(recording, out)
        }
    }
}

fn label(arguments: &TaskArgs) -> anyhow::Result<Outcome> {
    let Some(task) = many::read_task(&arguments.out, arguments.task)? else {
        say(&format!("task {}: nothing to do, for its recording was planned anew", arguments.task));
        return Ok(Outcome::Done);
    };
    let done = many::label_one(&task, arguments.jobs, &Stages::default())?;
    let sequence = &task.stretch.sequence;
    labelled_without(sequence, &done.unreadable, &done.cameras).for_each(|line| say(&line));
    for scan in &done.not_labelled {
        say(&format!("not labelled: {}", scan.told(sequence)));
    }
    Ok(Outcome::done_if(done.not_labelled.is_empty()))
}

/// A recording that can't be put together is named, and costs the others nothing.
fn assemble(arguments: &AssembleArgs) -> anyhow::Result<Outcome> {
    let out = &arguments.out;
    if !out.try_exists().with_context(|| out.display().to_string())? {
        bail!("{}: expected what `ralf cluster plan` wrote, found no such folder", out.display());
    }
    let folders = many::planned(&arguments.out)?;
    if folders.is_empty() {
        bail!("{}: expected what `ralf cluster plan` wrote, found nothing", arguments.out.display());
    }
    let jobs = NonZeroUsize::new(threads(arguments.jobs)).unwrap_or(NonZeroUsize::MIN);
    let (mut recordings, mut detections, mut outcome) = (0, 0, Outcome::Done);
    for folder in &folders {
        let stages = Stages::default();
        stages.name_recording(&folder.display().to_string());
        match many::assemble(folder, jobs, &stages) {
            Ok(done) => {
                recordings += 1;
                say_sequences_left_out(folder, &done.left_out);
                say_gone(folder, &done.gone);
                let radars = done.record.radars().flat_map(|radar| &radar.detections);
                detections += radars.map(|count| u64::from(*count)).sum::<u64>();
                all_labelled_without(&done.record)
                    .for_each(|line| say(&format!("{}: {line}", folder.display())));
                for line in not_labelled(&done.record) {
                    say(&format!("not labelled: {}: {line}", folder.display()));
                    outcome = Outcome::Partial;
                }
            }
            Err(error) => {
                say(&format!("no labels: {}: {error}", folder.display()));
                outcome = Outcome::Partial;
            }
        }
    }
    print(&format!("{} of {} recordings, {} detections", recordings, folders.len(), grouped(detections)))?;
    Ok(outcome)
}
