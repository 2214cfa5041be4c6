//! Tuning: which settings come nearest to corrected labels (paper, section 2.4; docs/method.md, section 10)?
//!
//! No mismatch `d` depends on `alpha`, the three `beta` or `w0`. A [`MismatchTable`] therefore keeps the mismatches of
//! every detection that has a truth, `d_lm` for each `K` and `d_tr` for each `n_b` of a [`Space`], and a trial of a
//! [`Search`] never touches a point cloud: it weighs the mismatches anew, and gives the labels that the labeler would
//! give.
//!
//! `w0` is not searched but solved for: given all `w`, only the values between two neighbouring ones differ in their
//! labels, so that one pass over them finds the best threshold there is.

mod ablation;
mod buckets;
mod cross_validation;
mod file;
mod gather;
pub mod learning;
mod mismatches;
mod objective;
mod search;
mod settings;
mod table;
mod threshold;

pub use ablation::{JudgedVariant, Variant};
pub use cross_validation::{Fold, check_folds, leave_one_out};
pub use file::settings_file;
pub use gather::Gatherer;
pub use mismatches::{DetectionMismatches, Weights};
pub use objective::{Objective, ObjectiveError};
pub use search::{Found, Search};
pub use settings::{Branches, Space, TunedSettings};
pub use table::MismatchTable;

use ralf::config::ConfigError;
use thiserror::Error;

/// Why settings can't be tuned.
#[derive(Debug, Error, PartialEq)]
pub enum TuneError {
    /// Every setting would do on labels of one class alone.
    #[error("expected plausible detections and artifacts to train on, found no {0}")]
    OneClass(&'static str),
    /// The same of what is left where one sequence is left out.
    #[error(
        "cross-validation without {left_out}: expected plausible detections and artifacts to train on, found no \
         {missing}"
    )]
    OneClassWithout {
        /// The sequence that holds the only ones.
        left_out: String,
        /// Which they are.
        missing: &'static str,
    },
    /// Leaving one sequence out must leave another to train on.
    #[error("cross-validation: expected two training sequences or more, found {0}")]
    TooFewSequences(usize),
    /// The table holds no mismatches for this setting.
    #[error("no mismatches were gathered for {key} = {value}")]
    NotGathered {
        /// Dotted name.
        key: &'static str,
        /// The value asked for.
        value: usize,
    },
    /// The optimiser refused.
    #[error("optimiser: {0}")]
    Optimiser(String),
    /// A setting out of its range.
    #[error(transparent)]
    Config(#[from] ConfigError),
}
