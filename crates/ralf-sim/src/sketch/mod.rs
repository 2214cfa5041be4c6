//! Sketched worlds: a second way to make worlds, of which [`crate::world`] knows nothing.
//!
//! What is learned in worlds of one make is learned about that make, too: models err in worlds of other people in
//! ways in which they don't in their own. So these have other places, things, sensors and errors, and a plainer
//! physics: whatever reflects is a spot of so many dBsm, every body takes so many dB from a wave that passes, smooth
//! faces show what lies before them once more behind them, and what else a radar reports is drawn as often as a sensor
//! is said to report it. docs/worlds.md tells what they are like and what they bring.

mod lidar;
mod moment;
mod places;
mod radar;
mod recording;
mod relief;
mod ride;
mod rig;
mod scene;
mod sequence;
mod things;
mod way;

pub use places::{PLACES, Place};
pub use recording::Recording;

#[cfg(test)]
mod tests;
