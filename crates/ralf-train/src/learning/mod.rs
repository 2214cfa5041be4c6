//! Learning: a [`Model`](ralf::learned::Model) is fitted to evidence whose truth is known.
//!
//! 1. A [`TrainingTable`] holds evidence and truth of many detections of several worlds, some of them as if less could
//!    be observed ([`View`]).
//! 2. [`fit`] grows a forest without each world, judges it there, calibrates by what all of them say of the worlds that
//!    they never saw, and grows the one that stays on everything.
//! 3. [`boost`] grows a forest; where it is asked for, a net that hears of the detections around is fitted beside it
//!    ([`NetParameters`]).
//!
//! [`correct`] adds to a model what it gets wrong in recordings that somebody corrected.
//!
//! [`second_opinion`] learns within a sequence, from what a person said of some of its detections.
//!
//! The same table and seed give the same model to the byte.

mod asked;
mod balance;
mod blanking;
mod boosting;
mod calibrate;
mod causes;
mod correcting;
mod fit;
mod fitting;
mod judge;
mod monotone;
mod net;
mod opinion;
mod random;
mod range;
mod scores;
mod suite;
mod table;
#[cfg(test)]
mod testing;
mod view;

pub use boosting::{Bins, Examples, Grown, Parameters, boost};
pub use correcting::{CorrectedModel, Correcting, Judged, LEFT_ALONE, Turns, correct};
pub use fit::{Fitted, LearnError, fit};
pub use fitting::Fitting;
pub use judge::LeftOut;
pub use monotone::direction;
pub use net::NetParameters;
pub use opinion::{Believed, second_opinion};
pub use scores::{Scored, Scores, best_threshold};
pub use suite::{SUITES, SuiteScores};
pub use table::{Known, TrainingTable};
pub use view::View;
