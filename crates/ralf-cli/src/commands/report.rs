//! `ralf report`: one page about a labelled recording.

use crate::arguments::{ChangedArgs, DatasetArgs, check_page};
use crate::corrections::say_orphaned;
use crate::outcome::Outcome;
use crate::progress::{Progress, say};
use crate::run_summary::{say_not_labelled, say_without};
use clap::Args;
use ralf_data::result::LabelledRun;
use ralf_report::Report;
use std::path::PathBuf;

/// What `ralf report` takes.
#[derive(Debug, Args)]
#[command(after_help = "\
The page is one file that needs nothing else. It compares the labels with the recording's corrected ones where there \
are some, and tells what the labels say by themselves where there are none.

Examples:
  ralf report recordings/city out -o report.html
  ralf report recordings/city out --sequence 00 --sequence 03 --scans-per-sequence 12 -o report.html")]
pub(crate) struct ReportArgs {
    #[command(flatten)]
    dataset: DatasetArgs,
    /// What `ralf label` wrote
    #[arg(value_name = "OUT")]
    labels: PathBuf,
    #[command(flatten)]
    changed: ChangedArgs,
    /// The page (HTML)
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Scans of each sequence that are drawn: a third of them the most uncertain, the others evenly spread
    #[arg(long, value_name = "N", default_value_t = 6)]
    scans_per_sequence: usize,
}

/// Writes the page.
pub(crate) fn run(arguments: &ReportArgs) -> anyhow::Result<Outcome> {
    check_page("--output", &arguments.output, &[&arguments.dataset.dataset, &arguments.labels])?;
    let recording = arguments.dataset.open_labelled(&arguments.labels, &arguments.changed)?;
    let report = Report {
        recording: &recording,
        out: &arguments.labels,
        scans_per_sequence: arguments.scans_per_sequence,
    };
    let progress = Progress::spinner();
    let page = report.page(&|step| progress.tell(step.to_owned()))?;
    drop(progress);
    ralf_data::write_named(&arguments.output, page.html.as_bytes())?;
    page.of_truth.iter().chain(&page.drawn_without).for_each(|line| say(line));
    say(&format!("wrote {}", arguments.output.display()));
    let outcome = say_orphaned(&page.orphaned);
    say_without("truth", &page.without_truth);
    say_without("labels", &page.without_labels);
    let mut record = LabelledRun::open(&arguments.labels)?.record().clone();
    let is_shown = |name: &str| recording.sequences.iter().any(|reader| reader.sequence().name == name);
    record.retain(|labelled| is_shown(&labelled.name));
    let outcome = outcome.and(say_not_labelled(&record));
    Ok(outcome.and(Outcome::done_if(page.without_labels.is_empty())))
}
