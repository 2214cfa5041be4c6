//! What tuning has found and what that reaches.

use ralf::config::Config;
use ralf::metrics::{Confusion, Scores};
use ralf_train::{Fold, Found, MismatchTable, Objective, TuneError, TunedSettings};
use serde::Serialize;
use serde_json::{Map, Value, json};

/// The result of `ralf tune`.
pub(super) struct Report {
    pub(super) objective: Objective,
    pub(super) trials: usize,
    pub(super) seed: u64,
    pub(super) base: TunedSettings,
    pub(super) found: Found,
    pub(super) train: Part,
    pub(super) test: Option<Part>,
    /// Empty without cross-validation.
    pub(super) folds: Vec<Fold>,
}

/// What the settings reach on some sequences, before and after.
#[derive(Debug, Serialize)]
pub(super) struct Part {
    pub(super) sequences: Vec<String>,
    pub(super) scans: usize,
    pub(super) base: Scores,
    pub(super) tuned: Scores,
}

impl Part {
    pub(super) fn of(
        sequences: &[(String, MismatchTable)],
        base: &Config,
        tuned: &TunedSettings,
    ) -> Result<Self, TuneError> {
        let scores = |settings: &TunedSettings| {
            let scans = sequences.iter().map(|(_, table)| table.confusions(settings));
            let scans: Vec<Vec<Confusion>> = scans.collect::<Result<_, _>>()?;
            Ok::<_, TuneError>(Scores::from_scans(&scans.concat()))
        };
        Ok(Self {
            sequences: sequences.iter().map(|(name, _)| name.clone()).collect(),
            scans: sequences.iter().map(|(_, table)| table.scans()).sum(),
            base: scores(&TunedSettings::from_config(base))?,
            tuned: scores(tuned)?,
        })
    }
}

impl Report {
    /// For machines; what was not asked for is null.
    pub(super) fn json(&self) -> Value {
        let folds: Vec<Value> = self.folds.iter().map(fold).collect();
        json!({
            "objective": self.objective.to_string(),
            "trials": self.trials,
            "seed": self.seed,
            "score": self.found.score,
            "settings": { "base": settings(&self.base), "tuned": settings(&self.found.settings) },
            "train": self.train,
            "test": self.test,
            "cross_validation": (!folds.is_empty()).then_some(folds),
        })
    }
}

fn fold(fold: &Fold) -> Value {
    json!({
        "left_out": fold.left_out,
        "settings": settings(&fold.found.settings),
        "score": fold.found.score,
        "base": fold.base,
        "tuned": fold.tuned,
    })
}

fn settings(settings: &TunedSettings) -> Value {
    let entries = settings.entries().map(|(key, value)| (key.to_owned(), json!(value)));
    Value::Object(Map::from_iter(entries))
}
