//! `ralf convert`: another format into the project's own, or into a recording as ROS keeps it.

use crate::arguments::{DatasetArgs, SettingsArgs, tell_held_motion, the_only, threads};
use crate::outcome::{Outcome, UsageError};
use crate::progress::say;
use crate::sequences::{shown, write_missing};
use crate::text::delayed;
use clap::Args;
use ralf_data::read::refuse_to_write_into;
use ralf_data::write::export::{RosFormat, write_ros};
use ralf_data::{Recording, SequenceReader, has_sequence};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// Endings of files that hold recordings, or something of them, and that aren't written here.
const OTHER_FILES: [&str; 17] = [
    "db3", "db", "sqlite", "zip", "tar", "gz", "tgz", "zst", "7z", "h5", "hdf5", "json", "npz", "parquet",
    "pcap", "pcd", "toml",
];

/// What is shown beside the progress.
const DOING: &str = "converting";

/// Arguments of `ralf convert`.
#[derive(Debug, Args)]
#[command(after_help = "\
Each sequence appears whole or not at all, and one that is there already is never overwritten: the same command, typed \
again, writes those that are missing. A name that ends in \
.mcap (ROS 2) or .bag (ROS 1) takes one sequence; beside it goes a .toml with the settings by which it is read back. \
What such a file can't hold is in docs/export.md. With --config, --set or --trajectory the recording is written as \
these correct it (tables `sensors`, `corrections` and `motion`), and needs no correction afterwards.

Examples:
  ralf convert nuscenes -o recordings/nuscenes --sequence scene-0061
  ralf convert recordings/city --sequence 00 -o city-00.mcap
  ralf convert drive -o recordings/drive --config fixes.toml --trajectory poses.tum")]
pub(crate) struct ConvertArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    /// Folder of the dataset that is written, or an .mcap or .bag file
    #[arg(short, long, value_name = "PATH")]
    output: PathBuf,
    #[command(flatten)]
    settings: SettingsArgs,
    /// Measurements side by side; as many as there are processors if not given. The files are the same for any number
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
}

/// Converts a recording.
pub(crate) fn run(arguments: &ConvertArgs) -> anyhow::Result<Outcome> {
    refuse_other_files(&arguments.output)?;
    let recording = opened(arguments)?;
    tell_held_motion(&recording);
    if let Some(format) = RosFormat::of_file(&arguments.output) {
        return as_ros(&recording, &arguments.output, format);
    }
    refuse_to_write_into(&recording.path, &arguments.output)?;
    let sequences: Vec<_> = recording.sequences.iter().map(|reader| reader.as_ref()).collect();
    let is_there = |reader: &dyn SequenceReader| has_sequence(reader, &arguments.output);
    write_missing(&sequences, &arguments.output, &is_there, threads(arguments.jobs), DOING)?;
    Ok(Outcome::Done)
}

/// Refuses a folder that is to have the name of a file of another kind: whoever types it expects that file.
fn refuse_other_files(output: &Path) -> Result<(), UsageError> {
    let ending = output.extension().unwrap_or_default();
    let is_file = OTHER_FILES.iter().any(|other| ending.eq_ignore_ascii_case(other));
    if output.is_dir() || !is_file {
        return Ok(());
    }
    let expected = "a folder's name, or one that ends in .mcap or .bag, which are the files that are written";
    Err(UsageError(format!("--output: expected {expected}, found {}", output.display())))
}

/// The recording, as the settings correct it where there are any.
fn opened(arguments: &ConvertArgs) -> anyhow::Result<Recording> {
    if !arguments.settings.are_given() {
        return arguments.dataset.open();
    }
    let mut settings = arguments.settings.resolve()?;
    settings.topics = arguments.dataset.topics_or(&settings.topics)?;
    arguments.dataset.open_corrected(&settings)
}

/// Converts the only sequence of a recording into one file.
fn as_ros(recording: &Recording, file: &Path, format: RosFormat) -> anyhow::Result<Outcome> {
    let reader = the_only(recording)?;
    let progress = shown(reader.sequence(), DOING);
    let written = write_ros(reader, file, format, &|done| progress.reached(done as u64))?;
    drop(progress);
    say(&format!("wrote {}", file.display()));
    if let Some(settings) = written.settings {
        say(&format!("wrote {}: the settings by which it is read back", settings.display()));
    }
    if written.delay_ns > 0 {
        say(&format!("warning: {}: {}", file.display(), delayed(written.delay_ns)));
    }
    if !written.left_out.is_empty() {
        let left_out = written.left_out.join(", ");
        say(&format!("warning: {}: such a file has no place for {left_out}: left out", file.display()));
    }
    Ok(Outcome::Done)
}
