//! The command line from outside: the built program on tiny recordings whose truth is known, on bad ones, and on real
//! ones.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "these are tests"
)]

mod ablation;
mod bad_files;
mod bad_images;
mod bad_messages;
mod bad_recordings;
mod browser;
mod camera_plot;
mod check;
mod cluster;
mod corrections;
#[cfg(feature = "depth")]
mod depth;
mod determinism;
mod errors;
mod evaluation;
mod evidence;
mod export;
#[cfg(unix)]
mod full_disk;
#[cfg(unix)]
mod inputs;
mod known_truth;
mod learning;
mod left_out;
mod names;
#[cfg(unix)]
mod odd_files;
mod other_commands;
mod other_data;
mod real_data;
mod reports;
mod resume;
#[cfg(unix)]
mod review;
mod ros;
#[cfg(feature = "depth")]
mod segment;
mod sequences;
mod simulation;
mod streams;
mod support;
mod trajectories;
mod tuning;
#[cfg(unix)]
mod verbs;
mod whole_run;
#[cfg(unix)]
mod writers;
