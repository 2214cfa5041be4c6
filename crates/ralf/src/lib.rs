//! RALF, the Radar Artifact Labeling Framework.
pub mod camera;
pub mod config;
pub mod geometry;
pub mod label;
pub mod measurement;
pub mod metrics;
pub mod motion;
pub mod rig;
pub mod source;
