//! A model that learns what it gets wrong.

use crate::corrections::{merged_truth, said_truth};
use crate::outcome::{Outcome, UsageError};
use crate::text::shell_path;
use anyhow::{Context, bail};
use clap::Args;
use ralf::config::Method;
use ralf::learned::Model;
use ralf_data::many::model_of;
use ralf_data::result::LabelledRun;
use ralf_data::{Corrections, GroundTruth, RECORD, Recording};
use std::path::{Path, PathBuf};

/// What belongs to models that are fitted anew.
const ANEW: [&str; 7] =
    ["preset", "seeds", "scans", "every", "no_neighbours", "without_groups", "no_blanking"];

/// Whether a model is corrected, which, and by what.
#[derive(Debug, Default, Args)]
pub(super) struct CorrectArgs {
    /// Correct the shipped model, or --model, by what people corrected and accepted in the review of OUT; every DATASET
    /// is one that was reviewed there
    #[arg(long, value_name = "OUT", requires = "datasets", conflicts_with_all = ANEW)]
    pub(super) from: Option<PathBuf>,
    /// Correct the shipped model, or --model, by the labels that DATASETs hold; with --from,
    /// by both
    #[arg(long, requires = "datasets", conflicts_with_all = ANEW)]
    correct: bool,
    /// With --from or --correct: the model to begin with, as `ralf learn` fitted it; the shipped one if not given
    #[arg(long, value_name = "MODEL", conflicts_with_all = ANEW)]
    model: Option<PathBuf>,
}

impl CorrectArgs {
    /// Whether any is.
    pub(super) fn is_asked(&self) -> bool {
        self.correct || self.from.is_some()
    }

    /// The model to begin with, where one is corrected; `output` is the file of what it becomes.
    pub(super) fn model(&self, output: &Path) -> anyhow::Result<Option<Model>> {
        let file = self.model.as_deref();
        if !self.is_asked() {
            let expected =
                "--model: expected --from OUT or --correct, which begin with a model, found neither";
            return if file.is_some() { Err(UsageError(expected.into()).into()) } else { Ok(None) };
        }
        if file.is_some_and(|file| is_same(file, output)) {
            let expected = "--output: expected another file than that of --model, which would be lost";
            return Err(UsageError(expected.into()).into());
        }
        let model = model_of(Method::Learned, file).context("--model")?;
        if let Some(Model { corrected: Some(_), origin, .. }) = &model {
            let expected =
                "expected a model as it was before it was corrected, so that nothing is learned twice";
            bail!(
                "--model: {expected}, found that of `{}`; leave --model out, or give the one that it began with",
                origin.command
            );
        }
        Ok(model)
    }

    /// The folder of the labels that people saw.
    pub(super) fn shown(&self) -> Option<&Path> {
        self.from.as_deref().map(Corrections::labels_of)
    }

    /// How that was labelled; of labels of another program nothing is known.
    pub(super) fn run(&self) -> anyhow::Result<Option<LabelledRun>> {
        let shown = self.shown().filter(|out| out.join(RECORD).exists());
        Ok(shown.map(LabelledRun::open).transpose()?)
    }

    /// What is known of a recording: what its review says, what it holds itself, or with both options one above the
    /// other.
    pub(super) fn truth(&self, recording: &Recording) -> anyhow::Result<(GroundTruth, Outcome)> {
        match &self.from {
            Some(out) if !self.correct => said_truth(recording, out),
            from => merged_truth(&recording.path, Some(recording), from.as_deref(), from.is_some()),
        }
    }

    /// As it was typed.
    pub(super) fn told(&self) -> String {
        let from = self.from.iter().map(|out| format!(" --from {}", shell_path(out)));
        let correct = self.correct.then(|| " --correct".to_owned());
        let model = self.model.iter().map(|model| format!(" --model {}", shell_path(model)));
        from.chain(correct).chain(model).collect()
    }
}

/// Whether two names are one file.
fn is_same(one: &Path, other: &Path) -> bool {
    matches!((one.canonicalize(), other.canonicalize()), (Ok(one), Ok(other)) if one == other)
}
