//! Small sequences in the published layout.

mod reading;
mod recording;
mod refusals;
