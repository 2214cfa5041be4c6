//! What is fitted and tuned from outside.
//!
//! One program for all: each of its own would be compiled and linked anew.

#![allow(clippy::expect_used, clippy::unwrap_used, reason = "these are tests")]

mod tune;
mod view;
