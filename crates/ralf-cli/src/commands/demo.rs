//! `ralf demo`: the method in one command, made of the commands that anyone would type.

use crate::cli::Cli;
use crate::commands::dispatch;
use crate::progress::say;
use crate::{Outcome, text::print};
use anyhow::Context;
use clap::{Args, Parser};
use std::path::PathBuf;

/// Arguments of `ralf demo`.
#[derive(Debug, Args)]
#[command(after_help = "\
Simulates a small recording whose truth is known, labels it, compares, and writes a report; each command is shown as it runs.

Examples:
  ralf demo
  ralf demo somewhere")]
pub(crate) struct DemoArgs {
    /// Folder for recording, labels and report
    #[arg(value_name = "DIR", default_value = "ralf-demo")]
    folder: PathBuf,
}

/// Runs the demonstration.
pub(crate) fn run(arguments: &DemoArgs) -> anyhow::Result<Outcome> {
    let place = |name: &str| {
        let path = arguments.folder.join(name);
        path.to_str().map(str::to_owned).with_context(|| format!("{}: expected a UTF-8 path", path.display()))
    };
    let (recording, labels, report) = (place("recording")?, place("labels")?, place("report.html")?);
    if arguments.folder.join("recording").exists() {
        say(&format!("{recording} is there already"));
    } else {
        step(&["simulate", "-o", &recording, "--preset", "tiny"])?;
    }
    step(&["label", &recording, "-o", &labels])?;
    step(&["evaluate", &labels, "--truth", &recording])?;
    step(&["report", &recording, &labels, "-o", &report])?;
    print(&format!(
        "\nOpen {report} in a browser. What to try next:\n  \
         ralf review {recording} {labels}    correct labels in the browser\n  \
         ralf plot {recording} {labels} --scan 6 -o scan.png\n  \
         ralf label {recording} -o {labels} --set fusion.alpha=1.0    LiDAR and cameras alone\n  \
         ralf inspect YOUR_RECORDING"
    ))?;
    Ok(Outcome::Done)
}

/// Shows a command and runs it.
fn step(command: &[&str]) -> anyhow::Result<Outcome> {
    say(&format!("\n$ ralf {}", command.join(" ")));
    let line = std::iter::once("ralf").chain(command.iter().copied());
    dispatch(Cli::try_parse_from(line).context("a command of the demonstration")?)
}
