//! Simulated recordings are like what they simulate.
//!
//! One program for all: each of its own would be compiled and linked anew.

#![allow(clippy::print_stdout, clippy::unwrap_used, reason = "these are tests")]

mod movers_and_slopes;
mod rolling;
mod sim_cameras;
mod simulation;
mod worlds;
