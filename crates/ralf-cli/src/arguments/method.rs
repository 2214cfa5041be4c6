//! Which method answers, and by which model.

use crate::outcome::UsageError;
use anyhow::Context;
use clap::{Args, ValueEnum};
use ralf::config::{Config, Method};
use ralf::learned::Model;
use std::path::PathBuf;

/// Who answers.
#[derive(Debug, Args)]
pub(crate) struct MethodArgs {
    /// Who answers; as `method` of the settings if not given
    #[arg(long, value_enum, value_name = "METHOD")]
    method: Option<TypedMethod>,
    /// The model that answers with the method that learns, as `ralf learn` wrote it; the shipped one if not given
    #[arg(long, value_name = "MODEL")]
    pub(crate) model: Option<PathBuf>,
}

/// A [`Method`], typed.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum TypedMethod {
    /// The paper's
    Paper,
    /// A model that weighs all evidence
    Learned,
}

impl MethodArgs {
    /// Puts the method into the settings. Returns the model, where one is asked.
    pub(crate) fn apply(&self, config: &mut Config) -> anyhow::Result<Option<Model>> {
        match self.method {
            Some(TypedMethod::Paper) => config.method = Method::Paper,
            Some(TypedMethod::Learned) => config.method = Method::Learned,
            None => {}
        }
        if config.method == Method::Paper && self.model.is_some() {
            let wanted = "--method learned, or method = \"learned\" in the settings";
            return Err(
                UsageError(format!("--model: expected the method that asks a model: {wanted}")).into()
            );
        }
        ralf_data::many::model_of(config.method, self.model.as_deref()).context("--model")
    }
}
