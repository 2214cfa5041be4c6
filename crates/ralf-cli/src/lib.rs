//! The command line of RALF. Results go to standard output, everything else to standard error.
//!
//! It is a library so that the Python package carries the same command.

mod arguments;
mod cli;
mod commands;
mod corrections;
#[cfg(feature = "depth")]
mod network;
mod outcome;
mod progress;
mod run_summary;
mod spent;
mod text;

use clap::Parser;
use outcome::{Outcome, UsageError};
use std::ffi::OsString;

/// Runs what was typed, the program's name first. Returns the exit status: 0 done, 1 failed, 2 wrong usage, 3 done, but
/// some scans are left out (each named).
pub fn run(typed: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match cli::Cli::try_parse_from(typed) {
        Ok(cli) => cli,
        // What was asked for by --help is no failure. Whoever reads it may have enough of it.
        Err(error) => {
            let _ = error.print();
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    match cli.run() {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::Partial) => 3,
        // Whoever reads our output has enough of it, as in `ralf inspect x | head`.
        Err(error) if text::is_broken_pipe(&error) => 0,
        Err(error) => {
            progress::say(&format!("error: {error:#}"));
            if error.is::<UsageError>() { 2 } else { 1 }
        }
    }
}
