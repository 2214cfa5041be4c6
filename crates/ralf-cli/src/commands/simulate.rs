//! `ralf simulate`: a recording whose truth is known.

use crate::arguments::threads;
use crate::outcome::{Outcome, UsageError};
use crate::progress::{Progress, say};
use anyhow::Context;
use clap::Args;
use clap::builder::PossibleValuesParser;
use ralf::sensors::Source;
use ralf_data::write_simulated;
use ralf_files::Kind;
use ralf_sim::presets::{self, Preset};
use ralf_sim::{Scenario, SimulatedSequence};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Scans of a scenario of one's own, where no number is given.
const USUAL_SCANS: usize = 100;

/// Arguments of `ralf simulate`.
#[derive(Debug, Args)]
#[command(after_help = "\
Writes LiDAR, four radars, four fisheye cameras with depth, wheel odometry, and the truth of every detection, in \
RALF's own layout. A sequence that is there already is never overwritten. The same preset, numbers and seed give the \
same bytes.

Examples:
  ralf simulate -o recordings/sim --scans 300         the paper's eleven sequences, each shorter
  ralf simulate -o recordings/sim                     all 2,704 scans of each radar: minutes, and some 6 GB
  ralf simulate -o recordings/tiny --preset tiny      in a second
  ralf simulate -o recordings/mine --scenario yard.toml --scans 200 --seed 3")]
pub(crate) struct SimulateArgs {
    /// Folder of the dataset that is written
    #[arg(short, long, value_name = "DATASET")]
    output: PathBuf,
    /// Which sequences
    #[arg(long, default_value = "paper", conflicts_with = "scenario",
        value_parser = PossibleValuesParser::new(presets::ALL.iter().map(|preset| preset.name)))]
    preset: String,
    /// A scenario of your own (TOML), as sequence 00
    #[arg(long, value_name = "FILE")]
    scenario: Option<PathBuf>,
    /// Only this sequence; may be given several times
    #[arg(long = "sequence", value_name = "NAME", conflicts_with = "scenario")]
    sequences: Vec<String>,
    /// Scans of each radar, over all sequences of the preset; all of them if not given
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..))]
    scans: Option<u32>,
    /// Of every random choice
    #[arg(long, default_value_t = 0, value_name = "S")]
    seed: u64,
    /// No cameras: all other measurements are the same, and made ten times as fast
    #[arg(long)]
    no_images: bool,
    /// Measurements side by side; as many as there are processors if not given. The files are the same for any number
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// No progress
    #[arg(short, long)]
    quiet: bool,
}

/// Makes a recording.
pub(crate) fn run(arguments: &SimulateArgs) -> anyhow::Result<Outcome> {
    let mut sequences = match &arguments.scenario {
        Some(file) => vec![own(file, arguments)?],
        None => preset(arguments)?,
    };
    if arguments.no_images {
        sequences = sequences.into_iter().map(SimulatedSequence::without_cameras).collect();
    }
    let steps: u64 = sequences.iter().map(|sequence| sequence.sequence().times.measurements() as u64).sum();
    let progress = if arguments.quiet { Progress::hidden() } else { Progress::of_steps(steps, "simulating") };
    let jobs = threads(arguments.jobs);
    write_simulated(&sequences, &arguments.output, jobs, &|done| progress.reached(done as u64))?;
    drop(progress);
    for sequence in &sequences {
        let folder = arguments.output.join("sequences").join(&sequence.sequence().name);
        say(&format!("wrote {}", folder.display()));
    }
    Ok(Outcome::Done)
}

/// The user's scenario.
fn own(file: &Path, arguments: &SimulateArgs) -> anyhow::Result<SimulatedSequence> {
    let name = || file.display().to_string();
    let text = ralf_files::read_text(file, Kind::Settings).with_context(name)?;
    let scenario = Scenario::from_toml(&text).with_context(name)?;
    let scans = arguments.scans.map_or(USUAL_SCANS, |scans| scans as usize);
    SimulatedSequence::new("00", &scenario, arguments.seed, scans).with_context(name)
}

/// The sequences of the preset that are asked for. Each has a seed of its own.
fn preset(arguments: &SimulateArgs) -> anyhow::Result<Vec<SimulatedSequence>> {
    let preset: &Preset = presets::find(&arguments.preset).context("no such preset")?;
    let names: Vec<&str> = preset.sequences.iter().map(|sequence| sequence.name).collect();
    if let Some(unknown) = arguments.sequences.iter().find(|name| !names.contains(&name.as_str())) {
        let known = names.join(", ");
        return Err(UsageError(format!("--sequence: expected one of {known}, found {unknown}")).into());
    }
    let spread = preset.spread(arguments.scans.map_or(preset.scans(), |scans| scans as usize));
    let wanted = |name: &str| arguments.sequences.is_empty() || arguments.sequences.iter().any(|n| n == name);
    let chosen = preset.sequences.iter().zip(spread).filter(|(sequence, _)| wanted(sequence.name));
    chosen.map(|(sequence, scans)| Ok(sequence.simulate(arguments.seed, scans)?)).collect()
}
