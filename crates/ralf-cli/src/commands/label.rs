//! `ralf label`: a plausibility and a label for every detection.

use super::check::page::doubts;
use crate::arguments::{
    DatasetArgs, MethodArgs, STORED_CLASSES, STORED_DEPTH, SettingsArgs, tell_held_motion, threads,
};
#[cfg(feature = "depth")]
use crate::network::{DepthModelArgs, depth_for_labelling};
use crate::outcome::Outcome;
use crate::progress::{Stages, say};
use crate::run_summary::{all_labelled_without, run_summary, say_gone, say_lacking, say_not_labelled};
use crate::spent::Work;
use crate::text::{counted, grouped, print};
use clap::Args;
use ralf::config::Config;
use ralf::learned::Model;
use ralf_data::run::{
    CheckRecord, LabelRun, Outcome as RunOutcome, SequenceRecord, check_all, check_output_folder,
};
use ralf_data::views::{lacking, with_stored};
use ralf_data::{Recording, Settings};
use std::num::NonZeroUsize;
use std::path::PathBuf;
use std::time::Instant;

/// Examples with networks, which not every build has.
const WITH_NETWORKS: &str = match cfg!(feature = "depth") {
    true => {
        "  \
  ralf label nuscenes -o out --depth-model midas.onnx      cameras, too: depth is stored in OUT/depth
  ralf label nuscenes -o out --segmentation classes        classes from images (`ralf segment nuscenes -o classes`)
"
    }
    false => "",
};

/// Arguments of `ralf label`.
#[derive(Debug, Args)]
#[command(after_help = format!("\
Writes OUT/run.json, OUT/sequences/NAME/plausibility.parquet and a .label file per scan. Killed and started again \
with the same arguments it goes on where it stopped. Sequences may be labelled into the same OUT one after the other; \
those that were labelled before are left as they are. All results in OUT have the same settings: those of other \
settings are removed or made again, and this is said.

Examples:
  ralf label recordings/city -o out
  ralf label nuscenes -o out --sequence scene-0061 --set tracking.sources=all
  ralf label recordings/city -o out --config ralf.toml --set fusion.alpha=0.7 --jobs 4
{WITH_NETWORKS}  ralf label recordings/city -o out --method learned       probabilities, with reasons (docs/learned.md)
  ralf label drive -o out --trajectory poses.tum --trajectory-frame lidar_top
  ralf label drive -o out --config fixes.toml              with what `ralf check drive --write fixes.toml` found"))]
pub(crate) struct LabelArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    /// Folder for the results
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    settings: SettingsArgs,
    #[command(flatten)]
    method: MethodArgs,
    #[cfg(feature = "depth")]
    #[command(flatten)]
    depth_model: DepthModelArgs,
    #[arg(long, value_name = "FOLDER", help = STORED_DEPTH)]
    #[cfg_attr(feature = "depth", arg(conflicts_with = "depth_model"))]
    depth: Option<PathBuf>,
    #[arg(long, value_name = "FOLDER", help = STORED_CLASSES)]
    segmentation: Option<PathBuf>,
    /// Gather what else is known of each detection: a column of plausibility.parquet for each piece (docs/evidence.md)
    #[arg(long)]
    evidence: bool,
    /// Scans side by side; as many as there are processors if not given
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Label nothing where the check of the recording doubts it, and end with status 3
    #[arg(long)]
    strict: bool,
    /// Leave out the check of the recording
    #[arg(long, conflicts_with = "strict")]
    no_check: bool,
    /// Print the record of these sequences as JSON
    #[arg(long)]
    json: bool,
    /// Say where the time went, as all threads together spent it
    #[arg(long)]
    timings: bool,
}

/// Labels a recording.
pub(crate) fn run(arguments: &LabelArgs) -> anyhow::Result<Outcome> {
    let begun = Instant::now();
    let mut settings = arguments.settings.resolve()?;
    let model = arguments.method.apply(&mut settings.method, &arguments.settings)?;
    let jobs = threads(arguments.jobs);
    settings.topics = arguments.dataset.topics_or(&settings.topics)?;
    let recording = arguments.dataset.open_corrected(&settings)?;
    let stages = Stages::default();
    arguments.refuse_place(&arguments.run_of(&recording, &settings, model.as_ref(), &[]), &stages)?;
    let checks = arguments.checks_before(&recording, jobs);
    if checks.iter().any(|check| !check.doubts.is_empty()) {
        say("nothing is labelled, for the recording is doubted (--strict)");
        return Ok(Outcome::Partial);
    }
    let recording = arguments.with_views(recording, &settings.method, jobs)?;
    let run = arguments.run_of(&recording, &settings, model.as_ref(), &checks);
    stages.spent.add(Work::Opening, begun.elapsed());
    let done = match arguments.strict || arguments.no_check {
        true => run.execute(&stages)?,
        false => run.execute_and_check(&stages, &|check| doubts(check).for_each(|line| stages.say(&line)))?,
    };
    if done.labelled.is_empty() {
        say("nothing to do: labelled before with the same program, settings and inputs");
    }
    say_gone(&recording.path, &done.gone);
    print(&if arguments.json { serde_json::to_string_pretty(&done.record)? } else { summary(&done) })?;
    if arguments.timings {
        say(&stages.spent.table());
    }
    all_labelled_without(&done.record).for_each(|line| say(&line));
    Ok(say_not_labelled(&done.record))
}

impl LabelArgs {
    /// What labels a recording.
    fn run_of<'a>(
        &'a self,
        recording: &'a Recording,
        settings: &'a Settings,
        model: Option<&'a Model>,
        checks: &'a [CheckRecord],
    ) -> LabelRun<'a> {
        let (out, jobs, evidence) = (self.output.as_path(), threads(self.jobs), self.evidence);
        LabelRun { recording, settings, out, jobs, evidence, model, checks }
    }

    /// The recording with what networks say of its images, computed now or before.
    fn with_views(&self, recording: Recording, config: &Config, jobs: usize) -> anyhow::Result<Recording> {
        let (depth, classes) = (self.depth.as_deref(), self.segmentation.as_deref());
        let recording = with_stored(recording, depth, classes)?;
        #[cfg(feature = "depth")]
        if let Some(model) = self.depth_model.load()? {
            return depth_for_labelling(recording, &model, &self.output, config, jobs);
        }
        let _ = jobs;
        say_lacking(&lacking(&recording, depth, classes, config)?);
        Ok(recording)
    }

    /// Refuses a place that can't take the results. Labelling asks whose labels are there by itself; here only
    /// where something that takes long comes before it.
    fn refuse_place(&self, run: &LabelRun, stages: &Stages) -> anyhow::Result<()> {
        check_output_folder(&run.recording.path, &self.output)?;
        #[cfg(feature = "depth")]
        let has_network = self.depth_model.depth_model.is_some();
        #[cfg(not(feature = "depth"))]
        let has_network = false;
        if self.strict || has_network {
            run.refuse_other_recording(stages)?;
        }
        Ok(())
    }

    /// Doubts that are to be known before anything is labelled, which are told. Without `--strict` checks go on
    /// meanwhile.
    fn checks_before(&self, recording: &Recording, jobs: usize) -> Vec<CheckRecord> {
        tell_held_motion(recording);
        let checks = if self.strict { check_all(recording, jobs) } else { Vec::new() };
        checks.iter().flat_map(doubts).for_each(|line| say(&line));
        checks
    }
}

/// What was labelled, and how fast those scans were that are new.
fn summary(done: &RunOutcome) -> String {
    run_summary(&done.record) + &if done.labelled.is_empty() { String::new() } else { speed(done) }
}

fn speed(done: &RunOutcome) -> String {
    let is_new = |sequence: &&SequenceRecord| done.labelled.contains(&sequence.name);
    let new = done.record.sequences.iter().filter(is_new);
    let counts: Vec<u64> = new
        .flat_map(|sequence| &sequence.radars)
        .flat_map(|radar| radar.detections.iter().copied().map(u64::from))
        .collect();
    let detections = counts.iter().sum();
    let seconds = done.record.timings.seconds;
    let rate = |count: u64| if seconds > 0.0 { count as f64 / seconds } else { 0.0 };
    format!(
        "\n{}, {} in {seconds:.1} s ({:.0} scans/s, {} detections/s, {})\n",
        counted(counts.len(), "scan"),
        counted(detections as usize, "detection"),
        rate(counts.len() as u64),
        grouped(rate(detections) as u64),
        counted(done.record.timings.jobs, "job"),
    )
}
