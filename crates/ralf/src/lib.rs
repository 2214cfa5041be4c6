//! RALF, the Radar Artifact Labeling Framework: which detections of a radar are real?
//!
//! Four in five automotive radar detections are artifacts. RALF asks the other sensors and time about each one, and
//! fuses the answers into a plausibility in [0, 1] and a label. This crate is the method, and nothing else: no files,
//! clocks, threads or printing. It follows *Radar Artifact Labeling Framework (RALF): Method for Plausible Radar
//! Detections in Datasets* (Isele, Schilling, Klein, Saralajew, Zoellner; VEHITS 2021).
//!
//! The path of a scan:
//!
//! 1. A [`sensors::Source`] reads measurements of a [`sensors::Rig`] on demand.
//! 2. [`space::sync`] says which belong together, and a [`scene::FrameWindow`] gathers them into a [`scene::Frame`], in
//!    bounded memory.
//! 3. [`paper::Labeler::label`] is the whole method. It asks [`paper::lidar`] (is there a surface?), [`paper::camera`]
//!    (is there an object in the scaled depth image?) and [`paper::tracking`] (is it there in the neighbouring scans,
//!    too?). All of them measure with the same [`scene::mismatch()`], and their answers become one plausibility.
//! 4. [`label`] says what a result means, and [`metrics`] compare it with a truth.
//!
//! | room | what it holds | depends on |
//! | --- | --- | --- |
//! | [`space`] | frames, motion, times, nearest points | |
//! | [`sensors`] | the rig, its cameras' lenses, what sensors deliver | `space` |
//! | [`label`] | classes, causes, flags | |
//! | [`config`] | every setting | `sensors` |
//! | [`scene`] | what surrounds one radar scan | `space`, `sensors`, `config` |
//! | [`paper`] | the paper's method | all above |
//! | [`evidence`] | what else can be observed of a detection | `scene`, `config` |
//! | [`learned`] | a model that weighs all evidence | `evidence`, `paper` |
//! | [`metrics`] | how good labels are | |

pub mod config;
pub mod evidence;
pub mod label;
pub mod learned;
pub mod metrics;
pub mod paper;
pub mod scene;
pub mod sensors;
pub mod space;
