//! Fitting a [`Model`](ralf::learned::Model) to evidence whose truth is known.

mod boosting;

pub use boosting::{Bins, Examples, Grown, Parameters, boost};
