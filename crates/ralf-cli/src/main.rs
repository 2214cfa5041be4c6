//! The command line of RALF. Results go to standard output, everything else to standard error; only `main` decides the exit
//! status: 0 done, 1 failed, 2 wrong usage, 3 done, but some scans are left out (each named).

mod cli;
mod commands;
mod corrections;
mod depth_model;
mod progress;
mod run_summary;
mod settings;
mod text;

use clap::Parser;
use std::process::ExitCode;

/// How a command ended that did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All of it.
    Done,
    /// Some scans are left out; each was named.
    Partial,
}

/// The user asked for something that doesn't exist.
#[derive(Debug)]
pub(crate) struct UsageError(pub(crate) String);

impl std::fmt::Display for UsageError {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for UsageError {}

fn main() -> ExitCode {
    let arguments = cli::Cli::parse();
    match commands::dispatch(arguments) {
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
