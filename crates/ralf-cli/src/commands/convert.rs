//! `ralf convert`: another format into the project's own.

use crate::Outcome;
use crate::cli::DatasetArgs;
use crate::progress::{STEPS, bar, say};
use clap::Args;
use ralf::source::Timelines;
use std::path::PathBuf;

/// Arguments of `ralf convert`.
#[derive(Debug, Args)]
#[command(after_help = "\
Each sequence appears whole or not at all, and one that is there already is never overwritten.

Example:
  ralf convert nuscenes -o recordings/nuscenes --sequence scene-0061")]
pub(crate) struct ConvertArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    /// Folder of the dataset that is written
    #[arg(short, long, value_name = "DATASET")]
    output: PathBuf,
}

/// Converts a recording.
pub(crate) fn run(arguments: &ConvertArgs) -> anyhow::Result<Outcome> {
    let recording = arguments.dataset.open()?;
    for reader in &recording.sequences {
        let sequence = reader.sequence();
        let bar = bar(measurements(&sequence.times), STEPS, format!("converting {}", sequence.name));
        ralf_data::write_sequence(reader.as_ref(), &arguments.output, &|done| bar.set_position(done as u64))?;
        bar.finish_and_clear();
        say(&format!("wrote {}", arguments.output.join("sequences").join(&sequence.name).display()));
    }
    Ok(Outcome::Done)
}

/// How many measurements all sensors delivered.
pub(crate) fn measurements(times: &Timelines) -> u64 {
    let Timelines { radars, lidars, cameras } = times;
    radars.iter().chain(lidars).chain(cameras).map(|times| times.len() as u64).sum()
}
