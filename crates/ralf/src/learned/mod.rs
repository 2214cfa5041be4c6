//! The method that learns: a [`Model`] weighs all evidence of a detection, and its answer is a calibrated probability
//! with reasons.
//!
//! A model is decision trees ([`Forest`]) over [evidence](crate::evidence), trained where the truth is known; `ralf
//! learn` makes one, and it is a text of its own format ([`Model::from_text`]). Evidence that was not observed is
//! ordinary: every question knows where absence leads. A small [`net`](net::Net) that hears of the detections around
//! may stand beside the trees. What lies outside of all that a model was trained on
//! ([`novelty`]) is left to the paper's method.

mod block;
mod bundle;
mod calibration;
mod familiar;
mod forest;
mod labeler;
mod model;
mod movers;
pub mod net;
mod outcomes;
mod reason;
mod rows;
mod shapley;
mod text;
mod tree;
mod unconfirmed;
mod visibility;
mod walk;
mod way;
mod weighing;

pub use block::Blocks;
pub use calibration::{Calibration, CalibrationError};
pub use familiar::{Seen, novelty};
pub use forest::{Forest, Inference, probability};
pub use labeler::{Answer, LearnedLabeler, LearnedScan, ToldCause, UNCLEAR};
pub use model::{CauseForest, Corrected, Input, Model, Origin, UseError, World};
pub use reason::NEIGHBOURS;
pub use rows::Rows;
pub use shapley::Explainer;
pub use text::ReadError;
pub use tree::{Leaf, Node, Split, Tree, TreeError};
pub use visibility::Visibility;
pub use weighing::Weighing;
