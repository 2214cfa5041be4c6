//! `ralf label`: a plausibility and a label for every detection.

use crate::Outcome;
use crate::cli::DatasetArgs;
use crate::depth_model::{DepthModelArgs, fill, images_of_scans};
use crate::progress::{Bars, say};
use crate::settings::{SettingsArgs, threads};
use crate::text::{aligned, grouped, percent, print};
use clap::Args;
use ralf::config::Config;
use ralf::labeler::flag;
use ralf_data::Recording;
use ralf_data::depth::DepthStore;
use ralf_data::run::{LabelRun, Outcome as RunOutcome, RadarRecord, RunRecord};
use ralf_depth::DepthEstimator;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Arguments of `ralf label`.
#[derive(Debug, Args)]
#[command(after_help = "\
Writes OUT/run.json, OUT/sequences/NAME/plausibility.parquet and a .label file per scan. Killed and started again with the same
arguments it goes on where it stopped. OUT holds the results of one run: those of another are replaced.

Examples:
  ralf label recordings/city -o out
  ralf label nuscenes -o out --sequence scene-0061 --set tracking.sources=all
  ralf label recordings/city -o out --config ralf.toml --set fusion.alpha=0.7 --jobs 4
  ralf label nuscenes -o out --depth-model midas.onnx      cameras, too: depth is stored in OUT/depth")]
pub(crate) struct LabelArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    /// Folder for the results
    #[arg(short, long, value_name = "OUT")]
    output: PathBuf,
    #[command(flatten)]
    settings: SettingsArgs,
    #[command(flatten)]
    model: DepthModelArgs,
    /// Take depth images from this folder, as `ralf depth -o` wrote them
    #[arg(long, value_name = "FOLDER", conflicts_with = "depth_model")]
    depth: Option<PathBuf>,
    /// Scans side by side; as many as there are processors if not given
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Print the record of the run as JSON
    #[arg(long)]
    json: bool,
    /// No progress
    #[arg(short, long)]
    quiet: bool,
}

/// Labels a recording.
pub(crate) fn run(arguments: &LabelArgs) -> anyhow::Result<Outcome> {
    let config = arguments.settings.resolve()?;
    let jobs = threads(arguments.jobs);
    let recording = arguments.with_depth(arguments.dataset.open()?, &config, jobs)?;
    let run = LabelRun { recording: &recording, config: &config, out: &arguments.output, jobs };
    let record = match run.execute(&Bars::new(arguments.quiet))? {
        RunOutcome::Labelled(record) => record,
        RunOutcome::Unchanged(record) => {
            say("nothing to do: labelled before with the same program, settings and inputs");
            record
        }
    };
    print(&if arguments.json { serde_json::to_string_pretty(&record)? } else { summary(&record) })?;
    let mut outcome = Outcome::Done;
    for (sequence, scan) in record.not_labelled() {
        say(&format!("not labelled: {sequence} {} scan {}: {}", scan.radar, scan.scan, scan.reason));
        outcome = Outcome::Partial;
    }
    Ok(outcome)
}

impl LabelArgs {
    /// The recording with the depth that was asked for: of a network, computed now as far as labelling needs it, or stored.
    fn with_depth(&self, recording: Recording, config: &Config, jobs: usize) -> anyhow::Result<Recording> {
        let store = match (self.model.load()?, &self.depth) {
            (Some(model), _) => {
                let network = model.fingerprint();
                let folder = self.output.join("depth").join(&network[..network.len().min(12)]);
                let store = DepthStore::create(&folder, model.output(), network)?;
                let tolerance = config.sync.camera_tolerance_ms;
                fill(&store, &recording, &model, |sequence| images_of_scans(sequence, tolerance), jobs)?;
                store
            }
            (None, Some(folder)) => DepthStore::open(folder)?,
            (None, None) => return Ok(recording),
        };
        Ok(store.attach(recording))
    }
}

/// A table with a row per radar, and what was missing.
fn summary(record: &RunRecord) -> String {
    let head =
        ["sequence", "radar", "scans", "detections", "plausible", "", "no LiDAR scan", "no neighbours"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for sequence in &record.sequences {
        rows.extend(sequence.radars.iter().map(|radar| summary_row(&sequence.name, radar)));
    }
    let detections: u64 = record.radars().flat_map(|radar| &radar.detections).copied().map(u64::from).sum();
    let scans: usize = record.radars().map(|radar| radar.detections.len()).sum();
    let seconds = record.timings.seconds;
    let rate = |count: f64| if seconds > 0.0 { count / seconds } else { 0.0 };
    format!(
        "{}{}\n{} scans, {} detections in {seconds:.1} s ({:.0} scans/s, {:.0}k detections/s, {} jobs)\n",
        aligned(&rows),
        camera_summary(record),
        grouped(scans as u64),
        grouped(detections),
        rate(scans as f64),
        rate(detections as f64) / 1e3,
        record.timings.jobs,
    )
}

/// A table with a row per camera whose images have depth; nothing without one.
fn camera_summary(record: &RunRecord) -> String {
    let asked = record.cameras().filter(|camera| !camera.images.is_empty());
    let mut rows: Vec<Vec<String>> = asked
        .map(|camera| {
            let (views, failed) = camera.views();
            let share = percent(failed as u64, views as u64);
            vec![
                camera.name.clone(),
                grouped(camera.images.len() as u64),
                grouped(views as u64),
                grouped(failed as u64),
                share,
            ]
        })
        .collect();
    if rows.is_empty() {
        return String::new();
    }
    rows.insert(0, ["camera", "images", "views", "failed", ""].map(str::to_owned).to_vec());
    format!("\n{}", aligned(&rows))
}

fn summary_row(sequence: &str, radar: &RadarRecord) -> Vec<String> {
    let total = |counts: &[u32]| counts.iter().copied().map(u64::from).sum::<u64>();
    let (detections, plausible) = (total(&radar.detections), total(&radar.plausible));
    let flagged = |flag: u16| radar.flags.iter().filter(|flags| **flags & flag != 0).count() as u64;
    let flagged = |flag: u16| match flagged(flag) {
        0 => "-".to_owned(),
        count => format!("{} scans", grouped(count)),
    };
    vec![
        sequence.to_owned(),
        radar.name.clone(),
        grouped(radar.detections.len() as u64),
        grouped(detections),
        grouped(plausible),
        percent(plausible, detections),
        flagged(flag::NO_LIDAR),
        flagged(flag::NO_NEIGHBOURS),
    ]
}
