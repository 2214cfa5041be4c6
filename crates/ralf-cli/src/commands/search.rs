//! What `ralf tune` and `ralf ablate` share: what is searched for, on which sequences, and how that is shown.

use crate::arguments::{DatasetArgs, STORED_DEPTH, SettingsArgs, threads};
use crate::corrections::{merged_truth, say_partly_corrected};
use crate::outcome::{Outcome, UsageError};
use crate::progress::{Progress, Stages};
use crate::run_summary::say_not_used;
use crate::text::shell_path;
use clap::Args;
use clap::builder::PossibleValuesParser;
use ralf::config::{Config, Method};
use ralf_data::views::with_stored;
use ralf_data::{GroundTruth, Recording, SequenceMismatches, Settings, gather_mismatches};
use ralf_train::{Found, MismatchTable, Objective, Search, TunedSettings};
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

/// What is searched for, and how long.
#[derive(Debug, Args)]
pub(super) struct SearchArgs {
    /// The recording's folder, which holds the corrected labels, too
    #[arg(value_name = "DATASET")]
    pub(super) dataset: PathBuf,
    /// Take the recording for this format
    #[arg(long, value_name = "FORMAT", value_parser = PossibleValuesParser::new(ralf_data::formats()))]
    format: Option<String>,
    /// Take the corrections of a review, too, from what `ralf label` wrote
    #[arg(long, value_name = "OUT")]
    corrections: Option<PathBuf>,
    #[arg(long, value_name = "FOLDER", help = STORED_DEPTH)]
    depth: Option<PathBuf>,
    /// Sequences to tune on
    #[arg(long, value_name = "NAME,...", value_delimiter = ',', required = true)]
    pub(super) train: Vec<String>,
    /// What to strive for: f1, iou, accuracy, or recall@precision=P
    #[arg(long, value_name = "OBJECTIVE", default_value = "f1")]
    pub(super) objective: Objective,
    /// How many settings to try
    #[arg(long, value_name = "N", default_value = "400")]
    pub(super) trials: NonZeroUsize,
    /// Of the search; the same seed finds the same settings
    #[arg(long, value_name = "S", default_value = "0")]
    pub(super) seed: u64,
    /// A setting that stays as it is, such as lidar.beta; may be given several times
    #[arg(long = "hold", value_name = "KEY", value_parser = PossibleValuesParser::new(TunedSettings::KEYS))]
    held: Vec<String>,
    #[command(flatten)]
    pub(super) settings: SettingsArgs,
    /// Scans to match side by side; as many as there are processors if not given
    #[arg(long, value_name = "N")]
    jobs: Option<NonZeroUsize>,
    /// Print the result as JSON
    #[arg(long)]
    pub(super) json: bool,
}

/// The mismatches of the sequences to train on and of those to judge by, each with its name.
pub(super) struct Parts {
    pub(super) train: Vec<(String, MismatchTable)>,
    pub(super) test: Vec<(String, MismatchTable)>,
}

/// The tables of named sequences.
pub(super) fn tables(sequences: &[(String, MismatchTable)]) -> Vec<&MismatchTable> {
    sequences.iter().map(|(_, table)| table).collect()
}

/// What there is beside the radars.
pub(super) struct Sensed {
    pub(super) lidar: bool,
    /// Depth of any camera's images.
    pub(super) depth: bool,
}

impl Sensed {
    pub(super) fn by(recording: &Recording) -> Self {
        let sequences = || recording.sequences.iter().map(|reader| (reader, reader.sequence()));
        Self {
            lidar: sequences()
                .any(|(_, sequence)| sequence.times.lidars.iter().any(|times| !times.is_empty())),
            depth: sequences().any(|(reader, sequence)| {
                (0..sequence.rig.cameras.len()).any(|camera| reader.has_depth(camera))
            }),
        }
    }
}

impl SearchArgs {
    /// Sequences can't be trained on and judged by, and each has a name and counts once.
    pub(super) fn check(&self, test: &[String]) -> Result<(), UsageError> {
        for (option, names) in [("--train", self.train.as_slice()), ("--test", test)] {
            if names.iter().any(String::is_empty) {
                let found = names.join(",");
                let expected = "expected names with a comma between two of them, found an empty one";
                return Err(UsageError(format!("{option}: {expected} in `{found}`")));
            }
            let twice = names.iter().enumerate().find(|(at, name)| names[..*at].contains(name));
            if let Some((_, twice)) = twice {
                return Err(UsageError(format!(
                    "{option}: expected each sequence once, found {twice} twice"
                )));
            }
        }
        if let Some(both) = self.train.iter().find(|name| test.contains(name)) {
            let reason = "a result is judged on sequences that the search did not see";
            return Err(UsageError(format!("--train and --test both name {both}: {reason}")));
        }
        Ok(())
    }

    /// What is only read.
    pub(super) fn read_only(&self) -> Vec<&Path> {
        [&self.dataset].into_iter().chain(&self.corrections).map(PathBuf::as_path).collect()
    }

    /// The settings to start from, which are those of the paper's method: a model is fitted and not searched for.
    pub(super) fn base(&self) -> anyhow::Result<Settings> {
        let base = self.settings.resolve()?;
        match base.method.method {
            Method::Paper => Ok(base),
            Method::Learned => Err(UsageError(
                "method = \"learned\": only the paper's method has settings to search for; `ralf learn` fits a model \
                 to corrected labels (--from OUT), and its --without-group tells what a group of evidence is good for"
                    .into(),
            )
            .into()),
        }
    }

    /// The recording of these sequences alone, its truth, and whether all corrections are part of that.
    pub(super) fn open(
        &self,
        base: &Settings,
        test: &[String],
    ) -> anyhow::Result<(Recording, GroundTruth, Outcome)> {
        let sequences = [self.train.as_slice(), test].concat();
        let (dataset, format) = (self.dataset.clone(), self.format.clone());
        let dataset = DatasetArgs { dataset, format, sequences, topics: None };
        let corrections = self.corrections.as_deref();
        let recording = with_stored(dataset.open_corrected(base)?, self.depth.as_deref(), None)?;
        let (truth, outcome) =
            merged_truth(&self.dataset, Some(&recording), corrections, corrections.is_some())?;
        say_partly_corrected(&truth);
        Ok((recording, truth, outcome))
    }

    /// Matches all scans of a recording that have truth.
    pub(super) fn gather(
        &self,
        recording: &Recording,
        truth: &GroundTruth,
        config: &Config,
    ) -> anyhow::Result<Vec<SequenceMismatches>> {
        Ok(gather_mismatches(recording, truth, config, threads(self.jobs), &Stages::default())?)
    }

    /// Which sequences are for training, and which for judging.
    pub(super) fn parts(&self, matched: Vec<SequenceMismatches>) -> Parts {
        let tables = matched.into_iter().map(|sequence| (sequence.not_used.sequence, sequence.table));
        let (train, test) = tables.partition(|(name, _)| self.train.contains(name));
        Parts { train, test }
    }

    pub(super) fn search<'a>(&self, base: &'a Config) -> Search<'a> {
        Search {
            base,
            objective: self.objective,
            trials: self.trials.get(),
            seed: self.seed,
            held: self.held.clone(),
        }
    }

    /// Of a search's trials.
    pub(super) fn progress(&self, name: &str) -> Progress {
        Progress::of_steps(self.trials.get() as u64, name)
    }

    /// How far the search has got, and the best so far.
    pub(super) fn show(&self, progress: &Progress, trial: usize, best: &Found) {
        progress.reached(trial as u64);
        let settings = best.settings.entries().map(|(key, value)| format!("{key}={value}")).join(" ");
        progress.tell(format!("best {} {:.3} with {settings}", self.objective, best.score));
    }

    /// The options that change the result of a search.
    pub(super) fn told(&self) -> String {
        let (objective, trials, seed) = (&self.objective, self.trials, self.seed);
        let held: String = self.held.iter().map(|key| format!(" --hold {key}")).collect();
        let corrections = self.corrections.iter().map(|out| format!(" --corrections {}", shell_path(out)));
        let depth = self.depth.iter().map(|folder| format!(" --depth {}", shell_path(folder)));
        let given = corrections.chain(depth).collect::<String>() + &self.settings.told();
        format!("--objective {objective} --trials {trials} --seed {seed}{held}{given}")
    }
}

/// Names the scans that could not be matched, and those that others were matched without.
pub(super) fn name_what_is_left_out(matched: &[SequenceMismatches]) -> Outcome {
    matched.iter().map(|sequence| say_not_used(&sequence.not_used)).fold(Outcome::Done, Outcome::and)
}
