//! The recording that a command works on.

use super::changed::ChangedArgs;
use super::settings;
use crate::outcome::say_left_out;
use crate::progress::say;
use crate::text::{counted, grouped, in_a_line, listed};
use anyhow::Context;
use clap::Args;
use ralf_data::read::inspection::held_motion;
use ralf_data::read::ros::{self, Topics};
use ralf_data::read::{Incomplete, Lost};
use ralf_data::result::LabelledRun;
use ralf_data::{DataError, Recording, SequenceReader, Settings, open_selected};
use std::collections::BTreeMap;
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
    /// Opens the recording, and says what its reader warns of.
    pub(crate) fn open(&self) -> anyhow::Result<Recording> {
        self.open_with(&self.topics_or(&Topics::new())?)
    }

    /// The same with the topics that `ralf label` used. It has to be what was labelled.
    pub(crate) fn open_labelled(&self, out: &Path, changed: &ChangedArgs) -> anyhow::Result<Recording> {
        let expected = "the folder or the file of the recording that was labelled";
        std::fs::metadata(&self.dataset)
            .map_err(|error| ralf_files::absent(error, expected))
            .with_context(|| self.dataset.display().to_string())?;
        let run = LabelledRun::open(out)?;
        let topics = self.topics_or(&run.settings().topics)?;
        let recording = run.settings().correct_labelled(self.read(&topics)?, |name| run.holds(name))?;
        let recording = told(recording);
        if self.sequences.is_empty() {
            changed.check_sequences(out, Some(&run), &recording)?;
        }
        changed.check(&run, &recording)?;
        Ok(recording)
    }

    /// The topics of `--topics`, or else these.
    pub(crate) fn topics_or(&self, topics: &Topics) -> anyhow::Result<Topics> {
        match &self.topics {
            Some(file) => settings::topics(file).context("--topics"),
            None => Ok(topics.clone()),
        }
    }

    /// The same with these topics.
    pub(crate) fn open_with(&self, topics: &Topics) -> anyhow::Result<Recording> {
        self.read(topics).map(told)
    }

    /// The same with the topics of these settings, and as they correct it.
    pub(crate) fn open_corrected(&self, settings: &Settings) -> anyhow::Result<Recording> {
        Ok(told(settings.correct(self.read(&settings.topics)?)?))
    }

    fn read(&self, topics: &Topics) -> anyhow::Result<Recording> {
        let recording = open_selected(&self.dataset, self.format.as_deref(), topics, &self.sequences)?;
        if let Some(file) = self.topics.as_ref().filter(|_| recording.format != ros::NAME) {
            let (file, dataset) = (file.display(), self.dataset.display());
            say(&format!("warning: --topics {file} is not used: {dataset} is no ROS recording"));
        }
        Ok(recording.copied())
    }
}

/// So many sequences are named that are left out.
const SHOWN: usize = 5;

/// A recording as it is, of which what is left out is told.
pub(crate) fn open_and_tell(dataset: &Path) -> Result<Recording, DataError> {
    let recording = ralf_data::open(dataset, None)?;
    tell_left_out(&recording);
    Ok(recording)
}

/// Says which sequences were left out and why: what was refused one by one, what is missing in one line for each
/// reason. No damage is only that of radars' files: large data sets are published part by part, with tables of all.
pub(crate) fn tell_left_out(recording: &Recording) {
    let all = recording.sequences.len() + recording.incomplete.len();
    let (mut damaged, mut not_copied) = (BTreeMap::<String, Vec<&str>>::new(), Vec::new());
    for Incomplete { name, lost } in &recording.incomplete {
        match lost {
            Lost::Refused(error) => say_left_out(&format!("{name}: {}", in_a_line(&error.to_string()))),
            Lost::Part(_) => damaged.entry(lost.to_string()).or_default().push(name),
            Lost::Radars => not_copied.push(name.as_str()),
        }
    }
    let some = |names: &[&str]| format!("{} of {}", grouped(names.len() as u64), counted(all, "sequence"));
    for (reason, names) in damaged {
        say_left_out(&format!("{}, for {reason}: {}", some(&names), listed(&names, SHOWN)));
    }
    if !not_copied.is_empty() {
        let (some, names) = (some(&not_copied), listed(&not_copied, SHOWN));
        say(&format!("warning: {some} left out, for {}: {names}", Lost::Radars));
    }
}

/// A recording, of which is said what was left out and what its readers warn of.
fn told(recording: Recording) -> Recording {
    tell_left_out(&recording);
    for reader in &recording.sequences {
        for warning in reader.warnings() {
            say(&format!("warning: {}: {warning}", reader.sequence().name));
        }
    }
    recording
}

/// Says, of a recording that is to be labelled or converted, which measurements lie outside of what is known of its
/// motion.
pub(crate) fn tell_held_motion(recording: &Recording) {
    for reader in &recording.sequences {
        let sequence = reader.sequence();
        if let Some(sentence) = held_motion(sequence) {
            say(&format!("warning: {}: {sentence}", sequence.name));
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
        listed(&names, 4 * SHOWN)
    )
}
