//! Damages every file that RALF opens, and watches what becomes of it: none may panic, hang, or take all memory.
//!
//! A case is a number, and the same number is the same case: [`Case::run`] picks a place, damages a file of it and does
//! with it what the commands do. [`watch`] runs cases in a process of their own and counts what goes wrong.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a check, whose own files are whole")]

mod case;
mod damage;
mod places;
mod tree;
mod verbs;
mod watch;

pub use case::{Case, all_cases};
pub use places::make_places;
pub use watch::{Failure, Watched, watch};
