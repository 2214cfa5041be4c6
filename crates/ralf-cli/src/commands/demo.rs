//! `ralf demo`: both methods in one command, made of the commands that anyone would type.

use super::{evaluate, label, report, simulate};
use crate::outcome::Outcome;
use crate::progress::say;
use crate::text::{print, shell_word};
use anyhow::Context;
use clap::{Args, Command};
use std::path::PathBuf;

/// Arguments of `ralf demo`.
#[derive(Debug, Args)]
#[command(after_help = "\
Simulates a small recording whose truth is known, labels it by the paper's method and by the one that learns, compares \
both with the truth, and writes a report with causes and reasons; each command is shown as it runs.

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
    let [recording, labels, learned, report] = ["recording", "labels", "learned", "report.html"].map(place);
    let (recording, labels, learned, report) = (recording?, labels?, learned?, report?);
    step(&["simulate", "-o", &recording, "--preset", "tiny"], simulate::run)?;
    step(&["label", &recording, "-o", &labels], label::run)?;
    step(&["evaluate", &labels, "--truth", &recording], evaluate::run)?;
    say("\nThe method that learns: a probability, causes and reasons.");
    step(&["label", &recording, "-o", &learned, "--method", "learned"], label::run)?;
    step(&["evaluate", &learned, "--truth", &recording], evaluate::run)?;
    step(&["report", &recording, &learned, "-o", &report], report::run)?;
    let [recording, labels, learned] = [recording, labels, learned].map(|path| shell_word(&path));
    print(&format!(
        "\nOpen {report} in a browser. What to try next, once `cargo install --path crates/ralf-cli` has built \
         all of it:\n  \
         ralf review {recording} {learned}    correct labels in the browser\n  \
         ralf plot {recording} {labels} --scan 6 -o scan.png\n  \
         ralf label {recording} -o {labels} --set fusion.alpha=1.0    LiDAR and cameras alone\n  \
         ralf inspect YOUR_RECORDING"
    ))?;
    Ok(Outcome::Done)
}

/// Shows a command and runs it.
fn step<A: Args>(words: &[&str], run: impl FnOnce(&A) -> anyhow::Result<Outcome>) -> anyhow::Result<Outcome> {
    let typed: Vec<String> = words.iter().map(|word| shell_word(word)).collect();
    say(&format!("\n$ ralf {}", typed.join(" ")));
    let command = A::augment_args(Command::new("ralf"));
    let typed = command.try_get_matches_from(words).context("a command of the demonstration")?;
    run(&A::from_arg_matches(&typed).context("a command of the demonstration")?)
}
