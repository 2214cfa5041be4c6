//! `ralf learn`: a model from recordings whose truth is known.

mod correct;
mod recordings;
mod text;
mod worlds;

use crate::arguments::{SettingsArgs, check_model, threads};
use crate::outcome::{Outcome, UsageError};
use crate::progress::{Progress, Stages, say};
use crate::text::{print, shell_word};
use anyhow::Context;
use clap::Args;
use clap::builder::PossibleValuesParser;
use correct::CorrectArgs;
use ralf::config::{Config, LearnedConfig};
use ralf::evidence::GROUPS;
use ralf::learned::{Model, Origin, Tree};
use ralf_data::result::LabelledRun;
use ralf_data::{Settings, TrainingGatherer, write_named};
use ralf_train::learning::{
    CorrectedModel, Correcting, Fitting, NetParameters, Parameters, TrainingTable, correct as correct_model,
    fit,
};
use recordings::{Gathering, RecordingArgs};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use worlds::WorldArgs;

/// Most trees that can be asked for: far beyond what any number of recordings makes use of.
const MOST_ROUNDS: i64 = 10_000;

/// The share of plausible detections that a model of simulated worlds alone expects: halfway, by the logarithm of the
/// odds, from what is plausible in these (0.44) to the one in five that is said of real radars (docs/learned.md).
const EXPECTED: f64 = 0.3;

/// Arguments of `ralf learn`.
#[derive(Debug, Args)]
#[command(after_help = "\
Fits gradient-boosted trees, and beside them a small net that hears of the detections around each one, to all \
evidence of detections whose truth is known (docs/learned.md). Recordings of one DATASET are a world; of a single \
DATASET every sequence is one. A model is judged in each world by one that was fitted to all the others, and that is \
what is printed and stands in the model's file. The same recordings, settings and seed give the same file.

With --from or --correct no model is fitted anew: the shipped one, or --model, learns what it gets wrong, in seconds. \
What people left alone in a scan that they corrected counts a little, too, as it was labelled. Each sequence is \
judged before, and after by corrections of the others alone. With --from the recording is read as it was labelled: \
settings and depth are those of OUT, below what is typed here.

Examples:
  ralf learn town motorway yard -o model.txt           recordings in RALF's layout, with ground_truth
  ralf learn --preset worlds -o model.txt              simulated on the way, eight of each family
  ralf learn --preset worlds --seeds 1 --scans 40 -o quick.txt
  ralf learn --preset worlds --no-neighbours -o trees.txt   trees alone: a third less to ask
  ralf learn recordings/city --from out -o own.txt     the shipped model, corrected by the review of out
  ralf learn recordings/city --correct -o own.txt      the same by the labels in the recording itself
  ralf label recordings/city -o out --method learned --model model.txt")]
pub(crate) struct LearnArgs {
    #[command(flatten)]
    recordings: RecordingArgs,
    /// The model's file
    #[arg(short, long = "output", visible_alias = "out", value_name = "MODEL")]
    output: PathBuf,
    #[command(flatten)]
    correct: CorrectArgs,
    #[command(flatten)]
    worlds: WorldArgs,
    /// Trees; 64 if not given, 40 where a model is corrected
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MOST_ROUNDS))]
    rounds: Option<u32>,
    /// Most leaves of a tree; 63 if not given, 12 where a model is corrected
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=Tree::MOST_LEAVES as i64))]
    leaves: Option<u32>,
    /// Trees alone, without the net that hears of the detections around each one: quicker to learn and to ask
    #[arg(long)]
    no_neighbours: bool,
    /// Groups of evidence that the model doesn't read; may be given several times
    #[arg(long = "without-group", value_name = "GROUP",
        value_parser = PossibleValuesParser::new(GROUPS))]
    without_groups: Vec<String>,
    /// Leave no group of evidence out of any scan: a model that knows no missing sensor
    #[arg(long)]
    no_blanking: bool,
    /// Of every random choice; the same seed fits the same model
    #[arg(long, value_name = "S", default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    settings: SettingsArgs,
    /// Scans and forests side by side; as many as there are processors if not given
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Print what the model is worth as JSON
    #[arg(long)]
    json: bool,
}

/// Gathers, fits or corrects, writes and prints what the model is worth.
pub(crate) fn run(arguments: &LearnArgs) -> anyhow::Result<Outcome> {
    let read_only: Vec<&Path> =
        arguments.recordings.datasets.iter().chain(&arguments.correct.from).map(PathBuf::as_path).collect();
    check_model("--output", &arguments.output, &read_only)?;
    let run = arguments.correct.run()?;
    let settings = arguments.settings.resolve_above(run.as_ref().map(LabelledRun::settings))?;
    arguments.check(&settings)?;
    if !arguments.correct.is_asked() && settings.method.learned.share != LearnedConfig::default().share {
        say(
            "warning: learned.share counts where a recording is labelled: what is fitted anew is judged without it",
        );
    }
    let begin = arguments.correct.model(&arguments.output)?;
    let stages = Stages::default();
    let jobs = threads(arguments.jobs);
    let (config, seed) = (&settings.method, arguments.seed);
    let (every, unsaid) = (arguments.worlds.every(), begin.is_some());
    let shown = arguments.correct.shown();
    let gatherer = TrainingGatherer { config, seed, unsaid, shown, every, jobs, observer: &stages };
    let mut table = gatherer.table();
    let (correct, beside_simulated) = (&arguments.correct, arguments.worlds.are_asked());
    let of = Gathering { settings: &settings, correct, run: run.as_ref(), beside_simulated };
    let mut outcome = arguments.recordings.gather(&gatherer, &of, &mut table)?;
    if beside_simulated {
        outcome = outcome.and(arguments.worlds.gather(&gatherer, &stages, &mut table)?);
    }
    let learned = match &begin {
        Some(begin) => arguments.correct(begin, &table, config, jobs)?,
        None => arguments.fit(&table.without_groups(&arguments.without_groups), config, jobs)?,
    };
    // First what it is worth: a disk that has become full takes no more than the file.
    let printed = print(if arguments.json { &learned.json } else { &learned.page });
    write_named(&arguments.output, learned.model.to_text().as_bytes())?;
    printed.map(|()| outcome)
}

/// A model, and what it is worth.
struct Learned {
    model: Model,
    page: String,
    json: String,
}

impl LearnArgs {
    /// What can be told before anything is gathered.
    fn check(&self, settings: &Settings) -> Result<(), UsageError> {
        if GROUPS.iter().all(|group| self.without_groups.iter().any(|without| without == group)) {
            return Err(UsageError("--without-group: no group of evidence is left to learn from".into()));
        }
        self.recordings.check(settings)
    }

    /// A new model.
    fn fit(&self, table: &TrainingTable, config: &Config, jobs: usize) -> anyhow::Result<Learned> {
        let fitting = Fitting {
            parameters: self.trees(Parameters::default()),
            expects: self.expects(),
            net: (!self.no_neighbours).then(NetParameters::default),
            blanking: !self.no_blanking,
            causes: true,
            threshold: config.fusion.threshold,
            learned: config.learned.clone(),
            jobs,
        };
        let progress = Progress::of_steps(0, "fitting");
        let reached = |done, of| progress.reached_of(done as u64, of as u64);
        let fitted = fit(table, &fitting, self.origin(&fitting.parameters), &reached)?;
        drop(progress);
        Ok(Learned { page: text::page(&fitted), json: text::json(&fitted)?, model: fitted.model })
    }

    /// A model that knows more.
    fn correct(
        &self,
        begin: &Model,
        table: &TrainingTable,
        config: &Config,
        jobs: usize,
    ) -> anyhow::Result<Learned> {
        let correcting = Correcting {
            parameters: self.trees(Correcting::trees()),
            threshold: config.fusion.threshold,
            learned: config.learned.clone(),
            jobs,
        };
        let progress = Progress::of_steps(0, "correcting");
        let reached = |done, of| progress.reached_of(done as u64, of as u64);
        let origin = self.origin(&correcting.parameters);
        let corrected = correct_model(begin, table, &correcting, origin, &reached);
        let CorrectedModel { model, judged } = corrected.with_context(|| self.heard())?;
        drop(progress);
        Ok(Learned { page: text::corrected_page(&judged), json: text::corrected_json(&judged)?, model })
    }

    /// What is learned from, for messages.
    fn heard(&self) -> String {
        let datasets = self.recordings.datasets.iter().chain(&self.correct.from);
        datasets.map(|place| place.display().to_string()).collect::<Vec<_>>().join(", ")
    }

    /// Trees as they are where nobody asks for others.
    fn trees(&self, usual: Parameters) -> Parameters {
        Parameters {
            rounds: self.rounds.map_or(usual.rounds, |rounds| rounds as usize),
            leaves: self.leaves.map_or(usual.leaves, |leaves| leaves as usize),
            seed: self.seed,
            ..usual
        }
    }

    /// Simulated worlds alone hold more plausible detections than recordings do.
    fn expects(&self) -> Option<f64> {
        self.recordings.datasets.is_empty().then_some(EXPECTED)
    }

    /// Where the model comes from: the command without what doesn't change it, with what its trees are like.
    fn origin(&self, Parameters { rounds, leaves, .. }: &Parameters) -> Origin {
        let recordings = self.recordings.told();
        let neighbours = if self.no_neighbours { " --no-neighbours" } else { "" };
        let mut without: String = self
            .without_groups
            .iter()
            .map(|group| format!(" --without-group {}", shell_word(group)))
            .collect();
        without += if self.no_blanking { " --no-blanking" } else { "" };
        let command = format!(
            "ralf learn{recordings}{}{} --rounds {rounds} --leaves {leaves}{neighbours}{without} --seed {}{}",
            self.correct.told(),
            self.worlds.told(),
            self.seed,
            self.settings.told(),
        );
        Origin { program: ralf_data::program(), command, seed: self.seed, worlds: Vec::new() }
    }
}
