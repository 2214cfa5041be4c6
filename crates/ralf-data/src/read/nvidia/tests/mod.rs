//! Small clips in the published layout.

mod reading;
mod recording;
mod refusals;
