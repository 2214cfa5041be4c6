//! How a model is fitted.

use super::boosting::Parameters;
use super::net::NetParameters;
use ralf::config::LearnedConfig;

/// How a model is fitted.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitting {
    /// Of the trees.
    pub parameters: Parameters,
    /// Of the net beside them; `None` where there is to be none.
    pub net: Option<NetParameters>,
    /// The share of plausible detections that the model expects where nobody says another; `None`: that of its worlds.
    pub expects: Option<f64>,
    /// Whether whole groups of evidence lack in some scans of the training.
    pub blanking: bool,
    /// Whether causes are learned, too.
    pub causes: bool,
    /// `w0`: what is labelled plausible.
    pub threshold: f64,
    /// How models' answers are weighed where they are judged.
    pub learned: LearnedConfig,
    /// Forests grown side by side; the result doesn't depend on it.
    pub jobs: usize,
}
