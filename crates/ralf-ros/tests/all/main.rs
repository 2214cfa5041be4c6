//! Containers and messages of ROS: files of other programs, damaged ones, copies.
//!
//! One program for all: each of its own would be compiled and linked anew.

#![allow(clippy::panic, clippy::unwrap_used, reason = "these are tests")]

mod containers;
mod copies;
mod fixtures;
mod fuzz;
mod messages;
