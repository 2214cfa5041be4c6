//! RALF, the Radar Artifact Labeling Framework: which detections of a radar are real?
//!
//! Four in five automotive radar detections are artifacts. RALF asks the other sensors and time about each one, and fuses the
//! answers into a plausibility in [0, 1] and a label. This crate is the method, and nothing else: no files, clocks, threads
//! or printing. It follows *Radar Artifact Labeling Framework (RALF): Method for Plausible Radar Detections in Datasets*
//! (Isele, Schilling, Klein, Saralajew, Zoellner; VEHITS 2021); equations are named by their labels there.
//!
//! The path of a scan:
//!
//! 1. A [`source::Source`] reads measurements of a [`rig::Rig`] on demand.
//! 2. [`sync`] says which belong together, and [`frame::FrameWindow`] gathers them into a [`frame::Frame`], in bounded memory.
//! 3. [`labeler::Labeler::label`] is the whole method. It asks [`lidar`] (is there a surface?), [`camera`] (is there an object
//!    in the scaled depth image?) and [`tracking`] (is it there in the neighbouring scans, too?). All of them measure with the
//!    same [`mismatch`]. [`fusion`] makes one plausibility of the answers, the
//!    [`evidence`].
//! 4. [`label`] and [`metrics`] compare the result with a truth, and [`tune`] seeks the settings that come nearest to it.
//!
//! [`sim`] makes recordings whose truth is known.

mod association;
pub mod camera;
pub mod config;
pub mod detections;
pub mod evidence;
pub mod frame;
pub mod fusion;
pub mod geometry;
pub mod label;
pub mod labeler;
pub mod lidar;
pub mod measurement;
pub mod metrics;
pub mod mismatch;
pub mod motion;
pub mod neighbors;
mod recent;
pub mod rig;
pub mod sim;
pub mod source;
pub mod sync;
pub mod tracking;
pub mod tune;
