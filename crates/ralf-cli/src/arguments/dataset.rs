//! The recording that a command works on.

use super::settings;
use crate::progress::say;
use anyhow::Context;
use clap::Args;
use ralf::config::{Config, Topics};
use ralf_data::run::read_record;
use ralf_data::{Recording, SequenceReader};
use std::path::{Path, PathBuf};

/// Which recording, and which part of it.
#[derive(Debug, Args)]
pub(crate) struct DatasetArgs {
    /// The recording: a folder, or a ROS bag or MCAP file; its format is recognised by what it holds
    #[arg(value_name = "DATASET")]
    pub(crate) dataset: PathBuf,
    /// Take the recording for this format
    #[arg(long, value_name = "FORMAT", value_parser = clap::builder::PossibleValuesParser::new(ralf_data::formats()))]
    pub(crate) format: Option<String>,
    /// Only this sequence; may be given several times
    #[arg(long = "sequence", value_name = "NAME")]
    pub(crate) sequences: Vec<String>,
    /// Which ROS topic is which sensor: the table `topics` of this settings file (TOML)
    #[arg(long, value_name = "FILE")]
    pub(crate) topics: Option<PathBuf>,
}

impl DatasetArgs {
    /// Opens the recording, and says what its reader warns of. Topics come from `--topics` alone.
    pub(crate) fn open(&self) -> anyhow::Result<Recording> {
        self.open_with(&self.with_topics(Config::default())?.topics)
    }

    /// The same with the topics that `ralf label` used, unless `--topics` names others.
    pub(crate) fn open_labelled(&self, out: &Path) -> anyhow::Result<Recording> {
        std::fs::metadata(&self.dataset).with_context(|| self.dataset.display().to_string())?;
        self.open_with(&self.with_topics(read_record(out)?.settings)?.topics)
    }

    /// The same with these topics.
    pub(crate) fn open_with(&self, topics: &Topics) -> anyhow::Result<Recording> {
        let recording = ralf_data::open_with(&self.dataset, self.format.as_deref(), topics)?;
        let recording =
            if self.sequences.is_empty() { recording } else { recording.select(&self.sequences)? };
        for reader in &recording.sequences {
            for warning in reader.warnings() {
                say(&format!("warning: {}: {warning}", reader.sequence().name));
            }
        }
        Ok(recording)
    }

    /// The settings with the topics of `--topics`, where that is given.
    pub(crate) fn with_topics(&self, config: Config) -> anyhow::Result<Config> {
        match &self.topics {
            Some(file) => Ok(Config { topics: settings::read(file)?.topics, ..config }),
            None => Ok(config),
        }
    }
}

/// The only sequence of a recording.
pub(crate) fn the_only(recording: &Recording) -> anyhow::Result<&dyn SequenceReader> {
    if let [reader] = recording.sequences.as_slice() {
        return Ok(reader.as_ref());
    }
    let names: Vec<_> = recording.sequences.iter().map(|reader| reader.sequence().name.as_str()).collect();
    anyhow::bail!(
        "expected one sequence, found {}: choose with --sequence ({})",
        names.len(),
        names.join(", ")
    )
}
