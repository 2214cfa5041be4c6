//! What can be typed.

use crate::commands::{
    ablate, check, convert, demo, depth, evaluate, export, inspect, label, plot, report, review, simulate,
    tune,
};
use anyhow::Context;
use clap::{Args, Parser, Subcommand};
use ralf_data::Recording;
use ralf_data::read::ros::Topics;
use ralf_data::result::{Change, LabelledRun};
use std::path::{Path, PathBuf};

/// Trustworthy labels for radar data: which detections are real, and which are artifacts?
#[derive(Debug, Parser)]
#[command(
    name = "ralf",
    version,
    max_term_width = 110,
    after_help = "\
Examples:
  ralf demo                                 see it work
  ralf inspect recordings/city              what is in there, and what is missing
  ralf check recordings/city                is it what it says: mountings, clocks, units, signs
  ralf label recordings/city -o out         a plausibility and a label for every detection
  ralf plot recordings/city out --sequence 00 --scan 17 -o scan.png
  ralf evaluate out --truth recordings/city
  ralf tune recordings/city -o ralf.toml --train 00,01 --test 02
  ralf report recordings/city out -o report.html
  ralf review recordings/city out           correct labels in the browser
  ralf export recordings/city out --to semantickitti --sensors -o kitti

Exit status: 0 done; 1 failed; 2 wrong usage; 3 done, but some scans are left out (each is named)."
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    /// The method in one command: simulate, label, evaluate, write a report
    Demo(demo::DemoArgs),
    /// Sensors, rates, gaps, offsets between sensors, what is missing
    Inspect(inspect::InspectArgs),
    /// Ask the sensors of a recording about each other: are its mountings, clocks, units and signs what it says?
    Check(check::CheckArgs),
    /// Label every radar detection of a recording
    Label(label::LabelArgs),
    /// Compute the depth of every camera image once for all, or check it against the LiDAR
    Depth(depth::DepthArgs),
    /// Compare labels with corrected ones, or tell what they say by themselves
    Evaluate(evaluate::EvaluateArgs),
    /// Find the settings that come nearest to corrected labels
    Tune(tune::TuneArgs),
    /// Tell what each branch and each extension of the method is good for
    Ablate(ablate::AblateArgs),
    /// Draw labelled scans from above
    Plot(plot::PlotArgs),
    /// Write one page about a labelled recording: figures, curves, pictures
    Report(report::ReportArgs),
    /// Correct labels by hand, on a page in the browser
    Review(review::ReviewArgs),
    /// Write labels in the formats of other tools
    Export(export::ExportArgs),
    /// Write a recording of another format in RALF's own layout, or as MCAP or bag
    Convert(convert::ConvertArgs),
    /// Make a recording whose truth is known
    Simulate(simulate::SimulateArgs),
    /// Print a completion script for a shell
    #[command(after_help = "Example:\n  ralf completions bash > /etc/bash_completion.d/ralf")]
    Completions {
        /// Which shell
        shell: clap_complete::Shell,
    },
}

/// The recording that a command works on.
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
        std::fs::metadata(&self.dataset).with_context(|| self.dataset.display().to_string())?;
        let run = LabelledRun::open(out)?;
        let recording =
            self.open_with(&self.topics_or(&run.settings().topics)?)?.corrected(run.settings())?;
        changed.check(&run, &recording)?;
        Ok(recording)
    }

    /// The topics of `--topics`, or else these.
    pub(crate) fn topics_or(&self, topics: &Topics) -> anyhow::Result<Topics> {
        self.topics
            .as_deref()
            .map_or_else(|| Ok(topics.clone()), |file| Ok(crate::settings::read(file)?.topics))
    }

    /// The same with these topics.
    pub(crate) fn open_with(&self, topics: &Topics) -> anyhow::Result<Recording> {
        let recording = ralf_data::open_with(&self.dataset, self.format.as_deref(), topics)?;
        let recording =
            if self.sequences.is_empty() { recording } else { recording.select(&self.sequences)? };
        for reader in &recording.sequences {
            let name = &reader.sequence().name;
            reader
                .warnings()
                .iter()
                .for_each(|warning| crate::progress::say(&format!("warning: {name}: {warning}")));
        }
        Ok(recording)
    }
}

/// What to do where labels belong to another recording.
#[derive(Debug, Clone, Default, Args)]
pub(crate) struct ChangedArgs {
    /// Go on though files of the recording are not those that were labelled; they are named
    #[arg(long)]
    pub(crate) changed_recording: bool,
}

impl ChangedArgs {
    /// Compares a recording with what was labelled. What differs is refused, or named where it is to be used all the same.
    pub(crate) fn check(&self, run: &LabelledRun, recording: &Recording) -> anyhow::Result<()> {
        let changes = run.changes(recording)?;
        let texts: Vec<String> = changes
            .iter()
            .map(|changed| {
                let found = match changed.change {
                    Change::Content => "another content",
                    Change::Missing => "no such file",
                    Change::New => "a file that wasn't there",
                };
                format!("{}: expected what was labelled, found {found}", changed.file.display())
            })
            .collect();
        if self.changed_recording {
            texts.iter().for_each(|text| crate::progress::say(&format!("warning: {text}")));
            return Ok(());
        }
        let Some(first) = texts.first() else { return Ok(()) };
        let more = texts.len() - 1;
        let more = if more > 0 { format!(", and so are {more} more files") } else { String::new() };
        anyhow::bail!("{first}{more}: label again, or go on with --changed-recording")
    }
}

/// The only sequence of a recording.
pub(crate) fn the_only(recording: &Recording) -> anyhow::Result<&dyn ralf_data::SequenceReader> {
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
