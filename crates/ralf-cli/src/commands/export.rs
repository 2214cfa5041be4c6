//! `ralf export`: labels in the formats of other tools.

use crate::arguments::{ChangedArgs, DatasetArgs};
use crate::corrections::say_orphaned;
use crate::outcome::{Outcome, UsageError};
use crate::progress::{Progress, say};
use crate::run_summary::say_without;
use crate::text::{counted, delayed};
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use ralf_data::write::export::{Export, ExportFormat, ExportOptions, Exported, Sensors, Split};
use std::path::PathBuf;

/// What `ralf export` takes.
#[derive(Debug, Args)]
#[command(after_help = "\
Labels are the ones that count: a person's correction, else what a person has accepted, else the machine's. They come \
alone unless --sensors asks for what the sensors measured; clouds (mcap, rosbag1, pcd) always hold the radars' \
detections. An export appears whole or not at all. Formats and fields: docs/export.md

Examples:
  ralf export recordings/city out --to mcap --sequence 00 -o city-00.mcap
  ralf export recordings/city out --to mcap --sensors=radar,lidar -o mcap
  ralf export recordings/city out --to semantickitti --sensors -o kitti
  ralf export recordings/city out --to parquet -o labels --sequence 00 --sequence 03
  ralf export recordings/city out --to npz --sensors --split plausible -o clean
  ralf export nuscenes out --to nuscenes -o radarseg")]
pub(crate) struct ExportArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    /// What `ralf label` wrote
    #[arg(value_name = "OUT")]
    labels: PathBuf,
    #[command(flatten)]
    changed: ChangedArgs,
    /// The format
    #[arg(long, value_name = "FORMAT",
        value_parser = PossibleValuesParser::new(ExportFormat::ALL.map(ExportFormat::name)))]
    to: String,
    /// Where it goes: a folder that is empty or not there yet; of one sequence also an .mcap or .bag file
    #[arg(short, long, value_name = "PATH")]
    output: PathBuf,
    /// Only detections of this kind
    #[arg(long, value_enum, default_value_t = Kind::All)]
    split: Kind,
    /// Add what the sensors measured: all of them, or some (`--sensors=radar,lidar`)
    #[arg(long, value_enum, value_name = "KINDS", value_delimiter = ',', num_args = 0..=3, require_equals = true,
        default_missing_value = "radar,lidar,camera")]
    sensors: Vec<Sensor>,
    /// Replace an earlier export in the same format
    #[arg(long)]
    force: bool,
}

/// `--split`
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Kind {
    Plausible,
    Artifact,
    All,
}

/// `--sensors`
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Sensor {
    Radar,
    Lidar,
    Camera,
}

/// Exports the labels of a recording.
pub(crate) fn run(arguments: &ExportArgs) -> anyhow::Result<Outcome> {
    let options = options(arguments)?;
    let recording = arguments.dataset.open_labelled(&arguments.labels, &arguments.changed)?;
    let export = Export { recording: &recording, out: &arguments.labels, options };
    let progress = Progress::of_steps(export.scans() as u64, format!("exporting {}", arguments.to));
    let exported = export.write(&arguments.output, &|scans| progress.reached(scans as u64))?;
    drop(progress);
    let (scans, detections) = (counted(exported.scans, "scan"), counted(exported.detections, "detection"));
    say(&format!("wrote {}: {scans}, {detections}", arguments.output.display()));
    for (sequence, delay_ns) in &exported.delayed {
        say(&format!("warning: {sequence}: {}", delayed(*delay_ns)));
    }
    Ok(name_what_is_missing(&exported))
}

fn options(arguments: &ExportArgs) -> anyhow::Result<ExportOptions> {
    let format = ExportFormat::named(&arguments.to);
    let format = format.ok_or_else(|| UsageError(format!("no format `{}`", arguments.to)))?;
    let has = |sensor| arguments.sensors.contains(&sensor);
    let sensors =
        Sensors { radar: has(Sensor::Radar), lidar: has(Sensor::Lidar), camera: has(Sensor::Camera) };
    if sensors.any() && !sensors.and(format.sensors()).any() {
        let reason = "its files have no place for them; those of mcap and rosbag1 have";
        return Err(UsageError(format!("--to {}: no data of these sensors: {reason}", arguments.to)).into());
    }
    let split = match arguments.split {
        Kind::Plausible => Split::Plausible,
        Kind::Artifact => Split::Artifact,
        Kind::All => Split::All,
    };
    Ok(ExportOptions { format, split, sensors, replace: arguments.force })
}

fn name_what_is_missing(exported: &Exported) -> Outcome {
    let outcome = say_orphaned(&exported.orphaned);
    for scan in &exported.not_labelled {
        say(&format!("not labelled: {scan}: exported without labels"));
    }
    say_without("labels", &exported.without_labels);
    let complete = exported.not_labelled.is_empty() && exported.without_labels.is_empty();
    outcome.and(Outcome::done_if(complete))
}
