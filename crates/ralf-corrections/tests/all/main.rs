//! The store of corrections from outside: its file, its operations, processes that are killed.
//!
//! One program for all: each of its own would be compiled and linked anew.

#![allow(clippy::panic, clippy::unwrap_used, reason = "these are tests")]

mod file;
mod killed;
mod named;
mod oracle;
mod store;
