//! `ralf label`: a plausibility and a label for every detection.

use super::check::page::doubts;
use crate::arguments::{DatasetArgs, MethodArgs, STORED_CLASSES, STORED_DEPTH, SettingsArgs, threads};
#[cfg(feature = "depth")]
use crate::network::{DepthModelArgs, depth_for_labelling};
use crate::outcome::Outcome;
use crate::progress::{Stages, say};
use crate::run_summary::{run_summary, say_not_labelled};
use crate::spent::Work;
use crate::text::{counted, grouped, print};
use clap::Args;
use ralf_data::Recording;
use ralf_data::run::{
    CheckRecord, LabelRun, Outcome as RunOutcome, RunRecord, SequenceRecord, check_all, check_output_folder,
};
use ralf_data::views::with_stored;
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
settings are removed, and this is said.

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
    let checks = arguments.checks_before(&recording, jobs)?;
    if checks.iter().any(|check| !check.doubts.is_empty()) {
        say("nothing is labelled, for the recording is doubted (--strict)");
        return Ok(Outcome::Partial);
    }
    let recording = with_stored(recording, arguments.depth.as_deref(), arguments.segmentation.as_deref())?;
    #[cfg(feature = "depth")]
    let recording = match arguments.depth_model.load()? {
        Some(model) => depth_for_labelling(recording, &model, &arguments.output, &settings.method, jobs)?,
        None => recording,
    };
    let run = LabelRun {
        recording: &recording,
        settings: &settings,
        out: &arguments.output,
        jobs,
        evidence: arguments.evidence,
        model: model.as_ref(),
        checks: &checks,
    };
    let stages = Stages::default();
    stages.spent.add(Work::Opening, begun.elapsed());
    let done = match arguments.strict || arguments.no_check {
        true => run.execute(&stages)?,
        false => run.execute_and_check(&stages, &|check| doubts(check).for_each(|line| stages.say(&line)))?,
    };
    say_what_changed(&done);
    print(&if arguments.json { serde_json::to_string_pretty(&done.record)? } else { summary(&done) })?;
    if arguments.timings {
        say(&stages.spent.table());
    }
    Ok(told_of_scans(&done.record))
}

/// Says which scans were left out, and how it ended by that.
fn told_of_scans(record: &RunRecord) -> Outcome {
    for (sequence, scan) in record.unreadable() {
        let (sensor, number, reason) = (&scan.sensor, scan.scan, &scan.reason);
        say(&format!("labelled without: {sequence} {sensor} scan {number}: {reason}"));
    }
    unusable_images(record).for_each(|line| say(&line));
    say_not_labelled(record)
}

/// For each camera with images that can't be read, the first of them: mostly all are alike.
fn unusable_images(record: &RunRecord) -> impl Iterator<Item = String> {
    let cameras = record
        .sequences
        .iter()
        .flat_map(|sequence| sequence.cameras.iter().map(move |camera| (&sequence.name, camera)));
    cameras.filter_map(|(sequence, camera)| {
        let mut images =
            camera.images.iter().filter_map(|image| Some((image.image, image.problem.as_ref()?)));
        let (first, reason) = images.next()?;
        let others = match images.count() {
            0 => String::new(),
            others => format!(" and {}", counted(others, "other")),
        };
        Some(format!("labelled without: {sequence} {} image {first}{others}: {reason}", camera.name))
    })
}

impl LabelArgs {
    /// What is to be known before anything is labelled: whether the results have a place, and doubts, which are told.
    /// Without `--strict` checks go on meanwhile.
    fn checks_before(&self, recording: &Recording, jobs: usize) -> anyhow::Result<Vec<CheckRecord>> {
        check_output_folder(&recording.path, &self.output)?;
        let checks = if self.strict { check_all(recording, jobs) } else { Vec::new() };
        checks.iter().flat_map(doubts).for_each(|line| say(&line));
        Ok(checks)
    }
}

/// What became of earlier results.
fn say_what_changed(done: &RunOutcome) {
    if !done.removed.is_empty() {
        let names = done.removed.join(", ");
        say(&format!(
            "removed, for they were made by another version, of a recording of another format or with other settings: \
             {names}"
        ));
    }
    for (sequence, file) in &done.damaged {
        let file = file.display();
        say(&format!("sequence {sequence} is labelled again: {file} is not as it was written"));
    }
    if done.labelled.is_empty() {
        say("nothing to do: labelled before with the same program, settings and inputs");
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
