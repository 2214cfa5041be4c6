//! Recordings in, labels and exports out: each reader and writer on files in its real layout.
//!
//! One program for all: each of its own would be compiled and linked anew.

#![allow(clippy::expect_used, clippy::print_stdout, clippy::unwrap_used, reason = "these are tests")]

mod conformance;
mod dataset;
mod export_ros;
mod layout;
mod learned;
#[cfg(unix)]
mod linked;
mod lorry;
mod many;
mod opinion;
mod program_identity;
mod read_again;
mod realism;
mod ros_beside;
mod ros_real;
mod same_scene;
mod segmentation;
mod simulated;
#[path = "../../src/read/truckscenes/tests/recording.rs"]
#[allow(dead_code, reason = "the tests of the reader use all of it")]
mod truckscenes;
