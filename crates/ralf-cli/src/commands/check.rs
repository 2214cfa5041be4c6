//! `ralf check`: is a recording what it says?

mod fixes;
pub(crate) mod page;
mod picture;

use crate::arguments::{DatasetArgs, SettingsArgs, check_editable, check_picture, refuse_same};
use crate::outcome::Outcome;
use crate::progress::{Progress, say};
use crate::text::print;
use clap::Args;
use ralf::sensors::Source;
use ralf_check::{Refinement, SequenceCheck, check_and_refine, check_with_figures};
use ralf_data::SequenceReader;
use std::path::{Path, PathBuf};

/// Corrections come from so many sequences of a recording at most, over the number of its LiDARs: what was read of them
/// is kept at once.
const REFINED: usize = 8;

/// Arguments of `ralf check`.
#[derive(Debug, Args)]
#[command(after_help = "\
Reads some hundred scans of each radar and some thirty of each LiDAR, and asks them about each other: range rates \
about the motion, detections about LiDAR points, LiDAR points about those half a second later. `docs/check.md` tells \
what is judged, and how. `ralf label` does the same while it labels, and with --strict before.

Examples:
  ralf check recordings/city
  ralf check recordings/city -o check.png
  ralf check recordings/city --write fixes.toml && ralf label recordings/city -o out --config fixes.toml
  ralf check city.mcap --config city.toml --write fixes.toml
  ralf label city.mcap -o out --config city.toml --config fixes.toml
  ralf check drive --trajectory poses.tum --trajectory-frame lidar_top

Exit status: 0 done, 1 failed, 2 wrong usage, and 3 with --strict where something is doubted.")]
pub(crate) struct CheckArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    #[command(flatten)]
    settings: SettingsArgs,
    /// End with status 3 where something is doubted
    #[arg(long)]
    strict: bool,
    /// Write corrections as settings that `ralf label --config` takes; nothing is corrected before. To refine
    /// them takes several times as long as the check alone. A file that was edited is not replaced
    #[arg(long, value_name = "FILE")]
    write: Option<PathBuf>,
    /// Draw velocities and overlaps of each radar (PNG). Only a picture is replaced
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// Everything that was judged, not only what is doubted
    #[arg(short, long)]
    verbose: bool,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// Checks a recording.
pub(crate) fn run(arguments: &CheckArgs) -> anyhow::Result<Outcome> {
    arguments.check_places()?;
    let mut settings = arguments.settings.resolve()?;
    settings.topics = arguments.dataset.topics_or(&settings.topics)?;
    let recording = arguments.dataset.open_corrected(&settings)?;
    let (checks, refined) = judged(&recording.sequences, arguments.write.is_some());
    // First what was found: a disk that has become full takes no more than the files.
    let printed = print(&if arguments.json {
        serde_json::to_string_pretty(&checks)?
    } else {
        checks.iter().map(|check| page::page(check, arguments.verbose)).collect::<String>()
    });
    if let Some(file) = &arguments.write {
        ralf_data::write_editable(file, &fixes::text(&checks, &refined, &settings)?)?;
        say(&format!("wrote {}", file.display()));
    }
    if let Some(file) = &arguments.output {
        ralf_data::write_named(file, &picture::png(&checks)?)?;
        say(&format!("wrote {}", file.display()));
    }
    printed?;
    let doubted = checks.iter().any(|check| check.doubts().next().is_some());
    Ok(Outcome::done_if(!doubted || !arguments.strict))
}

/// Judges all sequences; where corrections are wanted, these too, from some of them.
fn judged(
    sequences: &[Box<dyn SequenceReader>],
    with_corrections: bool,
) -> (Vec<SequenceCheck>, Vec<Refinement>) {
    let lidars = sequences.iter().map(|source| source.sequence().rig.lidars.len()).max().unwrap_or(0);
    let most = (REFINED / lidars.max(1)).max(1);
    let refining = if with_corrections { sequences.len().min(most) } else { 0 };
    let is_refined = |i: usize| (0..refining).any(|part| part * sequences.len() / refining == i);
    let some = (0..sequences.len()).filter(|i| is_refined(*i)).map(|i| sequences[i].as_ref() as &dyn Source);
    let progress = Progress::of_steps(sequences.len() as u64, "checking sequences");
    progress.tell(if refining > 0 {
        format!("what to correct, from {refining} of them")
    } else {
        String::new()
    });
    let (checked, refined) = check_and_refine(&some.collect::<Vec<_>>());
    let mut checked = checked.into_iter();
    let one = |i: usize| {
        let known = if is_refined(i) { checked.next() } else { None };
        progress.tell(sequences[i].sequence().name.clone());
        let checked = known.unwrap_or_else(|| check_with_figures(sequences[i].as_ref()));
        progress.advance(1);
        checked
    };
    ((0..sequences.len()).map(one).collect(), refined)
}

impl CheckArgs {
    /// Refuses places for files before the recording is read.
    fn check_places(&self) -> anyhow::Result<()> {
        let recording: &Path = &self.dataset.dataset;
        if let Some(file) = &self.write {
            check_editable("--write", file, fixes::BEGIN, &[recording])?;
        }
        if let Some(file) = &self.output {
            check_picture("--output", file, &[recording])?;
        }
        if let (Some(settings), Some(picture)) = (&self.write, &self.output) {
            refuse_same(["--write", "--output"], [settings, picture])?;
        }
        Ok(())
    }
}
