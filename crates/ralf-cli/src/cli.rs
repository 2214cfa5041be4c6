//! What can be typed, and what then runs.

#[cfg(feature = "review")]
use crate::commands::review;
use crate::commands::{
    ablate, assign, check, cluster, convert, demo, evaluate, export, inspect, label, learn, plot, report,
    simulate, tune,
};
#[cfg(feature = "depth")]
use crate::commands::{depth, segment};
use crate::outcome::{Outcome, UsageError};
use crate::progress;
use crate::text::print;
use clap::{CommandFactory, Parser, Subcommand};

/// The example of a command that not every build has.
const REVIEW: &str = match cfg!(feature = "review") {
    true => "  ralf review recordings/city out           correct labels in the browser\n",
    false => "",
};

/// Trustworthy labels for radar data: which detections are real, and which are artifacts?
#[derive(Debug, Parser)]
#[command(
    name = "ralf",
    version,
    max_term_width = 110,
    after_help = format!("\
Examples:
  ralf demo                                 see it work
  ralf inspect recordings/city              what is in there, and what is missing
  ralf check recordings/city                is it what it says: mountings, clocks, units, signs
  ralf label recordings/city -o out         a plausibility and a label for every detection
  ralf plot recordings/city out --sequence 00 --scan 17 -o scan.png
  ralf evaluate out --truth recordings/city
  ralf tune recordings/city -o ralf.toml --train 00,01 --test 02
  ralf report recordings/city out -o report.html
{REVIEW}  ralf export recordings/city out --to semantickitti --sensors -o kitti

Exit status: 0 done; 1 failed; 2 wrong usage; 3 done, but some scans, or corrections, are left out (each is named).")
)]
pub(crate) struct Cli {
    #[command(subcommand)]
    command: Command,
    /// No progress
    #[arg(short, long, global = true)]
    quiet: bool,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Both methods in one command: simulate, label, evaluate, write a report
    Demo(demo::DemoArgs),
    /// Sensors, rates, gaps, offsets between sensors, what is missing
    Inspect(inspect::InspectArgs),
    /// Ask the sensors of a recording about each other: are its mountings, clocks, units and signs what it says?
    Check(check::CheckArgs),
    /// Label every radar detection of a recording
    Label(label::LabelArgs),
    /// Label many recordings on many machines, in three steps
    Cluster(cluster::ClusterArgs),
    #[cfg(feature = "depth")]
    /// Compute the depth of every camera image once for all, or check it against the LiDAR
    Depth(depth::DepthArgs),
    #[cfg(feature = "depth")]
    /// Compute the class of every pixel of every camera image once for all
    Segment(segment::SegmentArgs),
    /// Compare labels with corrected ones, or tell what they say by themselves
    Evaluate(evaluate::EvaluateArgs),
    /// Find the settings that come nearest to corrected labels
    Tune(tune::TuneArgs),
    /// Fit a model to recordings whose truth is known: for `ralf label --method learned`
    Learn(learn::LearnArgs),
    /// Tell what each branch and each extension of the method is good for
    Ablate(ablate::AblateArgs),
    /// Draw labelled scans from above
    Plot(plot::PlotArgs),
    /// Write one page about a labelled recording: figures, curves, pictures
    Report(report::ReportArgs),
    /// Deal labelled sequences to people, and scans that are labelled twice
    Assign(assign::AssignArgs),
    #[cfg(feature = "review")]
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

impl Cli {
    /// Runs what was typed.
    pub(crate) fn run(self) -> anyhow::Result<Outcome> {
        if self.quiet {
            progress::be_quiet();
        }
        ralf_files::check_environment().map_err(|error| UsageError(error.to_string()))?;
        match self.command {
            Command::Demo(arguments) => demo::run(&arguments),
            Command::Inspect(arguments) => inspect::run(&arguments),
            Command::Check(arguments) => check::run(&arguments),
            Command::Label(arguments) => label::run(&arguments),
            Command::Cluster(arguments) => cluster::run(&arguments),
            #[cfg(feature = "depth")]
            Command::Depth(arguments) => depth::run(&arguments),
            #[cfg(feature = "depth")]
            Command::Segment(arguments) => segment::run(&arguments),
            Command::Evaluate(arguments) => evaluate::run(&arguments),
            Command::Tune(arguments) => tune::run(&arguments),
            Command::Learn(arguments) => learn::run(&arguments),
            Command::Ablate(arguments) => ablate::run(&arguments),
            Command::Plot(arguments) => plot::run(&arguments),
            Command::Report(arguments) => report::run(&arguments),
            Command::Assign(arguments) => assign::run(&arguments),
            #[cfg(feature = "review")]
            Command::Review(arguments) => review::run(&arguments),
            Command::Export(arguments) => export::run(&arguments),
            Command::Convert(arguments) => convert::run(&arguments),
            Command::Simulate(arguments) => simulate::run(&arguments),
            Command::Completions { shell } => {
                let mut script = Vec::new();
                clap_complete::generate(shell, &mut Self::command(), "ralf", &mut script);
                print(&String::from_utf8_lossy(&script)).map(|()| Outcome::Done)
            }
        }
    }
}
