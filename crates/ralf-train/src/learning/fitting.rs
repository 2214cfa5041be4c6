//! How a model is fitted.

use super::boosting::Parameters;
use super::net::NetParameters;

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
    /// What the odds of detections that only the radar tells of are multiplied by, as `learned.unconfirmed` says.
    pub unconfirmed: f64,
    /// Whether each scan tells how many of its movers are real, as `learned.movers` says.
    pub movers: bool,
    /// Forests grown side by side; the result doesn't depend on it.
    pub jobs: usize,
}
