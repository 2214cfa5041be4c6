//! `ralf inspect`: what a recording holds, and what is missing; or what a run of `ralf label` made.

mod distributions;
mod ros;

use super::check::page::page as check_page;
use crate::arguments::{DatasetArgs, SettingsArgs, threads};
use crate::outcome::{Outcome, UsageError};
use crate::progress::Progress;
use crate::run_summary::run_summary;
use crate::text::{aligned, counted, grouped, listed, print};
use clap::Args;
use ralf::config::Config;
use ralf::sensors::Timelines;
use ralf_check::SequenceCheck;
use ralf_data::read::inspection::{Inspection, SensorInspection, Unreadable};
use ralf_data::read::meanings;
use ralf_data::result::{Places, is_under_way};
use ralf_data::run::{RunRecord, read_record};
use ralf_data::{Recording, SequenceReader};
use serde_json::json;
use std::path::PathBuf;

/// So many sequences are named where another one was asked for.
const SHOWN: usize = 20;

/// Arguments of `ralf inspect`.
#[derive(Debug, Args)]
#[command(after_help = "\
Every radar and LiDAR scan is read once, so that those that can't be are found before labelling. Shown a folder that
`ralf label` wrote, it tells what was labelled, and which cameras failed, and why.

Examples:
  ralf inspect recordings/city --sequence 00
  ralf inspect drive.mcap --write-topics ralf.toml
  ralf inspect recordings/city --distributions
  ralf inspect out")]
pub(crate) struct InspectArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    #[command(flatten)]
    settings: SettingsArgs,
    /// Of a ROS recording: write a first guess of the table `topics` here, to be checked and then given as --config
    #[arg(long, value_name = "FILE", conflicts_with = "json")]
    write_topics: Option<PathBuf>,
    /// Look at times alone: don't read the scans to find those that can't be read
    #[arg(long)]
    quick: bool,
    /// Tell instead what its measurements are like: ranges, strengths, range rates, persistence (docs/realism.md)
    #[arg(long, conflicts_with_all = ["quick", "write_topics"])]
    distributions: bool,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Looks into a recording.
pub(crate) fn run(arguments: &InspectArgs) -> anyhow::Result<Outcome> {
    let folder = &arguments.dataset.dataset;
    if Places::new(folder).record_file().is_file() || is_under_way(folder)? {
        return inspect_run(arguments);
    }
    let mut settings = arguments.settings.resolve()?;
    if let Some(file) = &arguments.write_topics {
        return ros::write_topics(&arguments.dataset, file);
    }
    let topics = ros::Look::at(&arguments.dataset)?;
    settings.topics = arguments.dataset.topics_or(&settings.topics)?;
    let opened = arguments.dataset.open_corrected(&settings);
    if let (Err(_), Some(topics), false) = (&opened, &topics, arguments.json) {
        // They tell why.
        print(&topics.page(&settings.topics)?)?;
    }
    let recording = opened?;
    if arguments.distributions {
        return distributions::show(&recording, threads(None), arguments.json);
    }
    let looks = looks(&recording, &settings.method, arguments.quick);
    let checks = checks(&recording, arguments.quick);
    if arguments.json {
        let format = recording.format;
        let meanings = meanings(format);
        let mut look = json!({ "format": format, "sequences": looks, "check": checks, "meanings": meanings });
        if let Some(topics) = topics {
            look["ros"] = serde_json::to_value(topics.inspection)?;
        }
        print(&serde_json::to_string_pretty(&look)?)?;
    } else {
        let head = topics.map_or(Ok(String::new()), |topics| topics.page(&settings.topics))?;
        let head = head + &meanings_page(&recording, looks.len());
        print(&looks.iter().fold(head, |text, look| text + "\n" + &page(look)))?;
        for check in checks {
            print(&("\n".to_owned() + &check_page(&check, false)))?;
        }
    }
    Ok(Outcome::Done)
}

impl InspectArgs {
    /// Options that say how a recording is read say nothing of labels.
    fn refuse_of_recordings(&self) -> Result<(), UsageError> {
        let DatasetArgs { format, topics, .. } = &self.dataset;
        let given = [
            ("--format", format.is_some()),
            ("--topics", topics.is_some()),
            ("--config, --set or --trajectory", self.settings.are_given()),
            ("--write-topics", self.write_topics.is_some()),
            ("--quick", self.quick),
            ("--distributions", self.distributions),
        ];
        let Some((option, _)) = given.into_iter().find(|(_, given)| *given) else { return Ok(()) };
        let out = self.dataset.dataset.display();
        Err(UsageError(format!("{option}: expected a recording, found what `ralf label` wrote ({out})")))
    }
}

/// Each sequence's sensors, times and scans.
fn looks(recording: &Recording, config: &Config, quick: bool) -> Vec<Inspection> {
    recording.sequences.iter().map(|reader| look_at(reader.as_ref(), config, quick)).collect()
}

/// What the sensors say of each other, unless only times are looked at.
fn checks(recording: &Recording, quick: bool) -> Vec<SequenceCheck> {
    let readers = recording.sequences.iter().filter(|_| !quick);
    readers.map(|reader| ralf_check::check_with_figures(reader.as_ref())).collect()
}

fn look_at(reader: &dyn SequenceReader, config: &Config, quick: bool) -> Inspection {
    let mut look = Inspection::new(reader, config);
    if !quick {
        let Timelines { radars, lidars, .. } = &reader.sequence().times;
        let scans = radars.iter().chain(lidars).map(|times| times.len() as u64).sum();
        let progress = Progress::of_steps(scans, format!("reading {}", look.name));
        look.try_scans(reader, threads(None), &|| progress.advance(1));
    }
    look
}

/// The labels of a run, of all sequences or of those that are asked for.
fn inspect_run(arguments: &InspectArgs) -> anyhow::Result<Outcome> {
    let out = &arguments.dataset.dataset;
    arguments.refuse_of_recordings()?;
    let mut record = read_record(out)?;
    let asked = &arguments.dataset.sequences;
    if let Some(unknown) = asked.iter().find(|name| record.sequence(name).is_none()) {
        let known: Vec<&str> = record.sequences.iter().map(|sequence| sequence.name.as_str()).collect();
        let (place, known) = (out.display(), listed(&known, SHOWN));
        return Err(
            UsageError(format!("--sequence: expected one of {place} ({known}), found {unknown}")).into()
        );
    }
    if !asked.is_empty() {
        record.retain(|sequence| asked.contains(&sequence.name));
    }
    if arguments.json {
        print(&serde_json::to_string_pretty(&record)?)?;
    } else {
        let RunRecord { version, format, inputs, .. } = &record;
        let files = grouped(inputs.len() as u64);
        let head = format!(
            "{}: labels of a recording ({format}, {files} files) by ralf {version}\n\n",
            out.display()
        );
        print(&(head + &run_summary(&record)))?;
    }
    Ok(Outcome::Done)
}

fn page(look: &Inspection) -> String {
    let head = ["sensor", "kind", "count", "rate", "jitter", "gaps", "longest", "to LiDAR", "with LiDAR"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    rows.extend(look.sensors.iter().map(row));
    let missing: String = look.missing.iter().map(|sentence| format!("  - {sentence}\n")).collect();
    let missing = if missing.is_empty() { missing } else { format!("missing:\n{missing}") };
    let missing = missing + &unreadable(&look.unreadable);
    format!(
        "{}  {}\n{:.1} s, {:.0} m, {} poses, {} odometry samples\n{}{missing}",
        look.name,
        look.title,
        look.seconds,
        look.path_m,
        grouped(look.poses as u64),
        grouped(look.odometry_samples as u64),
        aligned(&rows),
    )
}

/// What was opened: which range rate it has, whether LiDAR points are of one time, and what the fields of quality mean.
fn meanings_page(recording: &Recording, count: usize) -> String {
    let (path, format) = (recording.path.display(), recording.format);
    let mut page = format!("{path} ({format}), {count} sequence(s)\n");
    let Some(found) = meanings(format) else { return page };
    let rigs = || recording.sequences.iter().map(|reader| &reader.sequence().rig);
    let has = |name: &str| rigs().flat_map(|rig| &rig.radars).any(|radar| radar.column(name).is_some());
    if has("doppler") || has("doppler_compensated") {
        page += &format!("  - range rates: {}\n", found.doppler);
    }
    if rigs().any(|rig| !rig.lidars.is_empty()) {
        page += &format!("  - LiDAR: {}\n", found.lidar);
    }
    for (name, meaning) in found.quality.iter().filter(|(name, _)| has(name)) {
        page += &format!("  - {name}: {meaning}; kept, and nothing is filtered by it\n");
    }
    page
}

/// The first scans that can't be read, and how many more there are.
fn unreadable(scans: &[Unreadable]) -> String {
    const SHOWN: usize = 10;
    let mut text = String::new();
    if !scans.is_empty() {
        text += &format!("{} can't be read:\n", counted(scans.len(), "scan"));
    }
    for Unreadable { sensor, scan, reason } in scans.iter().take(SHOWN) {
        text += &format!("  - {sensor} scan {scan}: {reason}\n");
    }
    if scans.len() > SHOWN {
        text += &format!("  - and {} more (--json lists all)\n", grouped((scans.len() - SHOWN) as u64));
    }
    text
}

fn row(sensor: &SensorInspection) -> Vec<String> {
    let value =
        |value: Option<f64>, unit: &str| value.map_or("-".to_owned(), |value| format!("{value:.1} {unit}"));
    let longest = sensor.gaps.iter().map(|gap| gap.ms).reduce(f64::max);
    vec![
        sensor.name.clone(),
        sensor.kind.to_owned(),
        grouped(sensor.count as u64),
        value(sensor.rate_hz, "Hz"),
        value(sensor.jitter_ms, "ms"),
        sensor.gaps.len().to_string(),
        value(longest, "ms"),
        value(sensor.lidar_offset_ms, "ms"),
        if sensor.kind == "lidar" { "-".to_owned() } else { grouped(sensor.with_lidar as u64) },
    ]
}
