//! One module per verb: thin, for what they do is done by the libraries.

pub(crate) mod ablate;
pub(crate) mod assign;
pub(crate) mod check;
pub(crate) mod cluster;
pub(crate) mod convert;
pub(crate) mod demo;
#[cfg(feature = "depth")]
pub(crate) mod depth;
pub(crate) mod evaluate;
pub(crate) mod export;
pub(crate) mod inspect;
pub(crate) mod label;
pub(crate) mod learn;
pub(crate) mod plot;
pub(crate) mod report;
#[cfg(feature = "review")]
pub(crate) mod review;
mod search;
#[cfg(feature = "depth")]
pub(crate) mod segment;
pub(crate) mod simulate;
pub(crate) mod tune;
