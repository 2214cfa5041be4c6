//! The command line of RALF. Results go to standard output, everything else to standard error; only `main` decides the
//! exit status: 0 done, 1 failed, 2 wrong usage, 3 done, but some scans are left out (each named).

mod arguments;
mod cli;
mod commands;
mod corrections;
#[cfg(feature = "depth")]
mod depth_model;
mod outcome;
mod progress;
mod run_summary;
mod text;

use clap::Parser;
use outcome::{Outcome, UsageError};
use std::process::ExitCode;

fn main() -> ExitCode {
    match cli::Cli::parse().run() {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Partial) => ExitCode::from(3),
        // Whoever reads our output has enough of it, as in `ralf inspect x | head`.
        Err(error) if text::is_broken_pipe(&error) => ExitCode::SUCCESS,
        Err(error) => {
            progress::say(&format!("error: {error:#}"));
            ExitCode::from(if error.is::<UsageError>() { 2 } else { 1 })
        }
    }
}
