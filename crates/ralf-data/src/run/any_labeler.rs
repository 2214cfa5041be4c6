//! Whoever answers: the paper's method, or a model.

use ralf::config::{Config, Method};
use ralf::learned::{LearnedLabeler, Model};
use ralf::paper::Labeler;

/// What answers.
pub(super) enum AnyLabeler<'a> {
    /// The paper's method.
    Paper(Labeler<'a>),
    /// A model.
    Learned(Box<LearnedLabeler<'a>>),
}

impl<'a> AnyLabeler<'a> {
    /// What answers with these settings. Fails with what is unsuitable, and why.
    pub(super) fn new(config: &'a Config, model: Option<&'a Model>) -> Result<Self, (&'static str, String)> {
        const METHOD: &str = "method = \"learned\"";
        match (config.method, model) {
            (Method::Paper, _) => {
                Labeler::new(config).map(Self::Paper).map_err(|error| ("settings", error.to_string()))
            }
            (Method::Learned, None) => Err((METHOD, "no model was given".to_owned())),
            (Method::Learned, Some(model)) => {
                let labeler =
                    LearnedLabeler::new(config, model).map_err(|error| (METHOD, error.to_string()))?;
                Ok(Self::Learned(Box::new(labeler)))
            }
        }
    }

    /// Whether it is a model.
    pub(super) fn asks_model(&self) -> bool {
        matches!(self, Self::Learned(_))
    }
}
