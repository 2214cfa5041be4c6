//! `ralf tune`: the settings that come nearest to corrected labels.

mod report;
mod text;

use crate::cli::DatasetArgs;
use crate::corrections::merged_truth;
use crate::progress::{Bars, STEPS, bar, say};
use crate::settings::{SettingsArgs, threads};
use crate::text::print;
use crate::{Outcome, UsageError};
use clap::Args;
use indicatif::ProgressBar;
use ralf::config::Config;
use ralf::tune::{EvidenceTable, Found, Objective, Search, leave_one_out, settings_file};
use ralf_data::{SequenceEvidence, gather_evidence, write_whole};
use report::{Part, Report};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Arguments of `ralf tune`.
#[derive(Debug, Args)]
#[command(after_help = "\
Searches fusion.alpha, fusion.threshold, lidar.beta, lidar.neighbours, camera.beta, tracking.beta and tracking.scans. The result is
judged on sequences that the search did not see.

Examples:
  ralf tune recordings/city -o ralf.toml --train 00,01 --test 02
  ralf tune recordings/city -o ralf.toml --train 00,01 --test 02 --objective recall@precision=0.8
  ralf tune recordings/city -o ralf.toml --train 00,01 --test 02 --corrections out
  ralf tune recordings/city -o ralf.toml --train 00,01,02,03 --cross-validate --trials 1000 --seed 7")]
pub(crate) struct TuneArgs {
    /// The recording's folder, which holds the corrected labels, too
    #[arg(value_name = "DATASET")]
    dataset: PathBuf,
    /// Take the recording for this format
    #[arg(long, value_name = "FORMAT", value_parser = clap::builder::PossibleValuesParser::new(ralf_data::formats()))]
    format: Option<String>,
    /// Take the corrections of a review, too, from what `ralf label` wrote
    #[arg(long, value_name = "OUT")]
    corrections: Option<PathBuf>,
    /// Settings file to write
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
    /// Sequences to tune on
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', required = true)]
    train: Vec<String>,
    /// Sequences to judge the result on
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', required_unless_present = "cross_validate")]
    test: Vec<String>,
    /// What to strive for: f1, iou, accuracy, or recall@precision=P
    #[arg(long, value_name = "OBJECTIVE", default_value = "f1")]
    objective: Objective,
    /// How many settings to try
    #[arg(long, value_name = "N", default_value = "400")]
    trials: NonZeroUsize,
    /// Of the search; the same seed finds the same settings
    #[arg(long, value_name = "S", default_value = "0")]
    seed: u64,
    /// Also leave out one training sequence in turn, and judge the settings found on the others by it
    #[arg(long)]
    cross_validate: bool,
    #[command(flatten)]
    settings: SettingsArgs,
    /// Scans to match side by side; as many as there are processors if not given
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// No progress
    #[arg(short, long)]
    quiet: bool,
}

/// Tunes, writes the settings and prints what they reach.
pub(crate) fn run(arguments: &TuneArgs) -> anyhow::Result<Outcome> {
    arguments.check()?;
    let base = arguments.settings.resolve()?;
    let evidence = arguments.gather(&base)?;
    let outcome = name_what_is_left_out(&evidence);
    let tables = evidence.into_iter().map(|sequence| (sequence.name, sequence.table));
    let (train, test): (Vec<_>, Vec<_>) = tables.partition(|(name, _)| arguments.train.contains(name));
    let report = arguments.tune(&base, &train, &test)?;
    let comment = text::comment(&report, &arguments.command());
    let tuned = report.found.settings.applied_to(&base);
    write_whole(&arguments.output, settings_file(&comment, &tuned)?.as_bytes())?;
    print(&if arguments.json { serde_json::to_string_pretty(&report.json())? } else { text::page(&report) })?;
    if !arguments.objective.is_met(report.found.score) {
        say(&format!("warning: no settings that were tried keep the floor of {}", arguments.objective));
    }
    Ok(outcome)
}

impl TuneArgs {
    /// What can be told before anything is read.
    fn check(&self) -> Result<(), UsageError> {
        if let Some(both) = self.train.iter().find(|name| self.test.contains(name)) {
            let reason = "a result is judged on sequences that the search did not see";
            return Err(UsageError(format!("--train and --test both name {both}: {reason}")));
        }
        if self.cross_validate && self.train.len() < 2 {
            return Err(UsageError("--cross-validate: expected two sequences or more in --train".into()));
        }
        if self.output.is_dir() {
            let file = self.output.display();
            return Err(UsageError(format!("--output: expected a file, found the folder {file}")));
        }
        Ok(())
    }

    /// Matches all scans of the sequences to train on and of those to judge by.
    fn gather(&self, base: &Config) -> anyhow::Result<Vec<SequenceEvidence>> {
        let sequences = [self.train.as_slice(), &self.test].concat();
        let dataset = DatasetArgs { dataset: self.dataset.clone(), format: self.format.clone(), sequences };
        let recording = dataset.open()?;
        let corrections = self.corrections.as_deref();
        let truth = merged_truth(&self.dataset, corrections, corrections.is_some())?;
        Ok(gather_evidence(&recording, &truth, base, threads(self.jobs), &Bars::new(self.quiet))?)
    }

    fn tune(
        &self,
        base: &Config,
        train: &[(String, EvidenceTable)],
        test: &[(String, EvidenceTable)],
    ) -> anyhow::Result<Report> {
        let search = Search { base, objective: self.objective, trials: self.trials.get(), seed: self.seed };
        let tables: Vec<&EvidenceTable> = train.iter().map(|(_, table)| table).collect();
        let shown = self.bar("tuning");
        let found = search.run(&tables, &mut |trial, best| show(&shown, trial, best, self.objective))?;
        shown.finish_and_clear();
        let folds = if self.cross_validate { self.cross_validate(&search, train)? } else { Vec::new() };
        Ok(Report {
            objective: self.objective,
            trials: self.trials.get(),
            seed: self.seed,
            base: ralf::tune::Settings::of(base),
            found,
            train: Part::of(train, base, &found.settings)?,
            test: if test.is_empty() { None } else { Some(Part::of(test, base, &found.settings)?) },
            folds,
        })
    }

    fn cross_validate(
        &self,
        search: &Search,
        train: &[(String, EvidenceTable)],
    ) -> anyhow::Result<Vec<ralf::tune::Fold>> {
        let shown = self.bar("cross-validation");
        let mut show = |left_out: &str, trial: usize, best: &Found| {
            shown.set_prefix(format!("cross-validation without {left_out}"));
            show(&shown, trial, best, self.objective);
        };
        let folds = leave_one_out(search, train, &mut show)?;
        shown.finish_and_clear();
        Ok(folds)
    }

    fn bar(&self, name: &str) -> ProgressBar {
        if self.quiet {
            return ProgressBar::hidden();
        }
        bar(self.trials.get() as u64, STEPS, name.to_owned())
    }

    /// The command that repeats this, without what doesn't change the result.
    fn command(&self) -> String {
        let test =
            if self.test.is_empty() { String::new() } else { format!(" --test {}", self.test.join(",")) };
        let cross_validate = if self.cross_validate { " --cross-validate" } else { "" };
        let corrections = self
            .corrections
            .as_ref()
            .map_or(String::new(), |out| format!(" --corrections {}", out.display()));
        format!(
            "ralf tune {} --train {}{test}{corrections}{cross_validate} --objective {} --trials {} --seed {}",
            self.dataset.display(),
            self.train.join(","),
            self.objective,
            self.trials,
            self.seed
        )
    }
}

/// How far the search has got, and the best so far.
fn show(shown: &ProgressBar, trial: usize, best: &Found, objective: Objective) {
    shown.set_position(trial as u64);
    let settings = best.settings.entries().map(|(key, value)| format!("{key}={value}")).join(" ");
    shown.set_message(format!("best {objective} {:.3} with {settings}", best.score));
}

fn name_what_is_left_out(evidence: &[SequenceEvidence]) -> Outcome {
    let mut outcome = Outcome::Done;
    for sequence in evidence {
        for scan in &sequence.left_out {
            say(&format!("left out: {} {} scan {}: {}", sequence.name, scan.radar, scan.scan, scan.reason));
            outcome = Outcome::Partial;
        }
    }
    outcome
}
