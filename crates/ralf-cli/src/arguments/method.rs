//! Which method answers, and by which model.

use anyhow::Context;
use clap::{Args, ValueEnum};
use ralf::config::{Config, Method};
use ralf::learned::Model;
use ralf_files::Kind;
use std::path::{Path, PathBuf};

/// Who answers.
#[derive(Debug, Args)]
pub(crate) struct MethodArgs {
    /// Who answers; as `method` of the settings if not given
    #[arg(long, value_enum, value_name = "METHOD")]
    method: Option<TypedMethod>,
    /// The model that answers with the method that learns, as `ralf learn` wrote it; the shipped one if not given
    #[arg(long, value_name = "MODEL")]
    model: Option<PathBuf>,
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
        match (config.method, &self.model) {
            (Method::Paper, _) => Ok(None),
            (Method::Learned, Some(file)) => read_model(file).map(Some),
            (Method::Learned, None) => Ok(Some(Model::shipped()?)),
        }
    }
}

/// The model of a file.
fn read_model(file: &Path) -> anyhow::Result<Model> {
    let name = || file.display().to_string();
    let text = ralf_files::read_text(file, Kind::Settings).with_context(name)?;
    let model = Model::from_text(&text).with_context(name)?;
    model.check().with_context(name)?;
    Ok(model)
}
