//! Worlds to train in: recordings that differ in physics and sensors as those of different people do.
//!
//! A [`Family`] is a set of ranges; a [`Recording`] is a world that a seed drew from it, or from a [`Mixture`] of
//! three: a vehicle with its sensors, how their waves behave, what the recording says wrongly of them, and some
//! sequences at places of their own. Unlike a [`crate::Scenario`], whose radar fills a quota, here the radar equation
//! decides what is detected: how many detections a scan has and which share of them is plausible follows.
//! docs/worlds.md tells what each family is like.

mod calibration;
mod camera;
mod draw;
mod family;
mod item;
mod lidar;
mod mixture;
mod place;
mod radar;
mod recording;
mod reflector;
mod scene;
mod sequence;
mod span;
mod terrain;

pub use family::{FAMILIES, Family};
pub use mixture::Mixture;
pub use recording::Recording;
