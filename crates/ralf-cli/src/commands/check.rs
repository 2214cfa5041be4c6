//! `ralf check`: is a recording what it says?

mod page;

use crate::arguments::{DatasetArgs, SettingsArgs};
use crate::outcome::Outcome;
use crate::text::print;
use clap::Args;
use ralf_check::{SequenceCheck, check};

/// Arguments of `ralf check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Reads some hundred scans of each radar and some thirty of each LiDAR, and asks them about each other: range rates \
about the motion, detections about LiDAR points, LiDAR points about those half a second later.

Examples:
  ralf check recordings/city
  ralf check recordings/city --strict && ralf label recordings/city -o out

Exit status: as always, and 3 with --strict where something is doubted.")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    #[command(flatten)]
    settings: SettingsArgs,
    /// End with status 3 where something is doubted
    #[arg(long)]
    strict: bool,
    /// Everything that was judged, not only what is doubted
    #[arg(short, long)]
    verbose: bool,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Checks a recording.
pub(crate) fn run(arguments: &CheckArgs) -> anyhow::Result<Outcome> {
    let settings = arguments.settings.resolve()?;
    let recording = arguments.dataset.open_with(&arguments.dataset.topics_or(&settings.topics)?)?;
    let checks: Vec<SequenceCheck> =
        recording.sequences.iter().map(|reader| check(reader.as_ref())).collect();
    if arguments.json {
        print(&serde_json::to_string_pretty(&checks)?)?;
    } else {
        print(&checks.iter().map(|check| page::page(check, arguments.verbose)).collect::<String>())?;
    }
    let doubted = checks.iter().any(|check| check.doubts().next().is_some());
    Ok(if doubted && arguments.strict { Outcome::Partial } else { Outcome::Done })
}
