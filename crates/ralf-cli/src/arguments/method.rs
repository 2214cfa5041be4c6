//! Which method answers, and by which model.

use super::settings::SettingsArgs;
use crate::outcome::UsageError;
use crate::progress::say;
use anyhow::Context;
use clap::{Args, ValueEnum};
use ralf::config::{Config, Method};
use ralf::learned::Model;
use std::path::PathBuf;

const NO_BRANCH: &str = "warning: lidar.enabled, camera.enabled and tracking.enabled are all false: every detection is \
                         an artifact";

/// Who answers.
#[derive(Debug, Args)]
pub(crate) struct MethodArgs {
    /// Who answers, whatever a settings file says; as `method` of the settings if not given
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
    /// Puts the method into the settings, which were resolved from these, and warns where nothing is left to ask.
    /// Returns the model, where one is asked.
    pub(crate) fn apply(
        &self,
        config: &mut Config,
        settings: &SettingsArgs,
    ) -> anyhow::Result<Option<Model>> {
        let asked = match self.method {
            Some(TypedMethod::Paper) => Method::Paper,
            Some(TypedMethod::Learned) => Method::Learned,
            None => config.method,
        };
        if asked != config.method && settings.has_set("method") {
            let expected = "expected the method of --set method=..., or one of the two options alone";
            return Err(UsageError(format!("--method: {expected}")).into());
        }
        config.method = asked;
        if config.method == Method::Paper && self.model.is_some() {
            let wanted = "--method learned, or method = \"learned\" in the settings";
            return Err(
                UsageError(format!("--model: expected the method that asks a model: {wanted}")).into()
            );
        }
        if config.method == Method::Paper && !config.has_branch() {
            say(NO_BRANCH);
        }
        ralf_data::many::model_of(config.method, self.model.as_deref()).context("--model")
    }
}
