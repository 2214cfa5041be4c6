//! The method from outside: on recordings in memory and simulated ones, with numbers worked out by hand and searches
//! without any shortcut.
//!
//! One program for all: each of its own would be compiled and linked anew.

#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "these are tests")]

mod camera_evidence;
mod evidence;
mod fisheye;
mod lidar_evidence;
mod lidar_scans;
mod method;
mod movers;
mod radar_evidence;
mod settings;
mod support;
mod window;
