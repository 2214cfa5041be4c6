//! `ralf tune`: the settings that come nearest to corrected labels.

mod report;
mod text;

use super::search::{Parts, SearchArgs, Sensed, name_what_is_left_out, tables};
use crate::arguments::check_editable;
use crate::outcome::{Outcome, UsageError};
use crate::progress::say;
use crate::text::{print, shell_path, shell_word};
use clap::Args;
use ralf::config::Config;
use ralf_data::{Settings, write_editable};
use ralf_train::{Found, MismatchTable, Search, TunedSettings, check_folds, leave_one_out, settings_file};
use report::{Part, Report};
use std::path::PathBuf;

/// Arguments of `ralf tune`.
#[derive(Debug, Args)]
#[command(after_help = "\
Searches fusion.alpha, fusion.threshold, lidar.beta, lidar.neighbours, camera.beta, tracking.beta and tracking.scans. \
The result is judged on sequences that the search did not see.

Examples:
  ralf tune recordings/city -o ralf.toml --train 00,01 --test 02
  ralf tune recordings/city -o ralf.toml --train 00,01 --test 02 --objective recall@precision=0.8
  ralf tune recordings/city -o ralf.toml --train 00,01 --test 02 --corrections out
  ralf tune recordings/city -o ralf.toml --train 00,01,02,03 --cross-validate --trials 1000 --seed 7")]
pub(crate) struct TuneArgs {
    #[command(flatten)]
    search: SearchArgs,
    /// Sequences to judge the result on
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', required_unless_present = "cross_validate")]
    test: Vec<String>,
    /// Also leave out one training sequence in turn, and judge the settings found on the others by it
    #[arg(long)]
    cross_validate: bool,
    /// Settings file to write; one that was edited is not replaced
    #[arg(short, long, value_name = "FILE")]
    output: PathBuf,
}

/// Tunes, writes the settings and prints what they reach.
pub(crate) fn run(arguments: &TuneArgs) -> anyhow::Result<Outcome> {
    arguments.check()?;
    let search = &arguments.search;
    let base = search.base()?;
    refuse_no_branch(&base.method)?;
    let (recording, truth, outcome) = search.open(&base, &arguments.test)?;
    refuse_blind(&base.method, &Sensed::by(&recording))?;
    let matched = search.gather(&recording, &truth, &base.method)?;
    let outcome = outcome.and(name_what_is_left_out(&matched));
    let report = arguments.tune(&base.method, &search.parts(matched))?;
    let comment = text::comment(&report, &arguments.command());
    let method = report.found.settings.applied_to(&base.method);
    let tuned = Settings { method, ..base };
    // First what was found: a disk that has become full takes no more than the file.
    let printed =
        print(&if search.json { serde_json::to_string_pretty(&report.json())? } else { text::page(&report) });
    write_editable(&arguments.output, &settings_file(&comment, &tuned)?)?;
    if !search.objective.is_met(report.found.score) {
        say(&format!("warning: no settings that were tried keep the floor of {}", search.objective));
    }
    printed.map(|()| outcome)
}

/// Without a branch there is no plausibility, and whatever is tried is as good as anything else.
fn refuse_no_branch(config: &Config) -> Result<(), UsageError> {
    if config.has_branch() {
        return Ok(());
    }
    let found = "lidar.enabled, camera.enabled and tracking.enabled are all false";
    Err(UsageError(format!("expected one branch or more whose settings are searched for, but {found}")))
}

/// Nor is there any where no branch that is on has anything to observe.
fn refuse_blind(config: &Config, sensed: &Sensed) -> Result<(), UsageError> {
    let lidar = config.lidar.enabled && sensed.lidar;
    let camera = config.camera.enabled && sensed.depth;
    if config.tracking.enabled || lidar || camera {
        return Ok(());
    }
    let branches = [
        (config.lidar.enabled, "lidar.enabled without a LiDAR"),
        (config.camera.enabled, "camera.enabled without depth of any camera"),
    ];
    let found: Vec<_> = branches.iter().filter(|(on, _)| *on).map(|(_, found)| *found).collect();
    let expected = "expected one branch or more that observes something in these sequences";
    Err(UsageError(format!("{expected}, found {}, and tracking.enabled is false", found.join(" and "))))
}

impl TuneArgs {
    /// What can be told before anything is read.
    fn check(&self) -> anyhow::Result<()> {
        self.search.check(&self.test)?;
        if self.cross_validate && self.search.train.len() < 2 {
            let expected = "--cross-validate: expected two sequences or more in --train";
            return Err(UsageError(expected.into()).into());
        }
        check_editable("--output", &self.output, text::BEGIN, &self.search.read_only())
    }

    fn tune(&self, base: &Config, Parts { train, test }: &Parts) -> anyhow::Result<Report> {
        let search = self.search.search(base);
        if self.cross_validate {
            check_folds(&search, train)?;
        }
        let progress = self.search.progress("tuning");
        let found =
            search.run(&tables(train), &mut |trial, best| self.search.show(&progress, trial, best))?;
        drop(progress);
        let folds = if self.cross_validate { self.cross_validate(&search, train)? } else { Vec::new() };
        Ok(Report {
            objective: search.objective,
            trials: search.trials,
            seed: search.seed,
            base: TunedSettings::from_config(base),
            found,
            train: Part::of(train, base, &found.settings)?,
            test: if test.is_empty() { None } else { Some(Part::of(test, base, &found.settings)?) },
            folds,
        })
    }

    fn cross_validate(
        &self,
        search: &Search,
        train: &[(String, MismatchTable)],
    ) -> anyhow::Result<Vec<ralf_train::Fold>> {
        let progress = self.search.progress("cross-validation");
        let mut show = |left_out: &str, trial: usize, best: &Found| {
            progress.name(format!("cross-validation without {left_out}"));
            self.search.show(&progress, trial, best);
        };
        Ok(leave_one_out(search, train, &mut show)?)
    }

    /// The command that repeats this, without what doesn't change the result.
    fn command(&self) -> String {
        let test = if self.test.is_empty() {
            String::new()
        } else {
            format!(" --test {}", shell_word(&self.test.join(",")))
        };
        let cross_validate = if self.cross_validate { " --cross-validate" } else { "" };
        format!(
            "ralf tune {} --train {}{test}{cross_validate} {}",
            shell_path(&self.search.dataset),
            shell_word(&self.search.train.join(",")),
            self.search.told(),
        )
    }
}
