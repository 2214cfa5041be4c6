//! The command line of RALF. Results go to standard output, everything else to standard error.
//!
//! It is a library so that the Python package carries the same command.

mod arguments;
#[cfg(feature = "review")]
mod browser;
mod cli;
mod commands;
mod corrections;
#[cfg(feature = "depth")]
mod network;
mod outcome;
mod progress;
mod run_summary;
mod sequences;
mod spent;
mod text;

use clap::Parser;
use outcome::{Outcome, UsageError, at_the_end};
use std::ffi::OsString;

/// Runs what was typed, the program's name first. Returns the exit status: 0 done, 1 failed, 2 wrong usage, 3 done, but
/// some sequences or scans are left out (each named).
pub fn run(typed: impl IntoIterator<Item = OsString>) -> u8 {
    let cli = match cli::Cli::try_parse_from(typed) {
        Ok(cli) => cli,
        Err(error) => {
            say_usage(&error);
            return u8::try_from(error.exit_code()).unwrap_or(2);
        }
    };
    match cli.run().map(at_the_end) {
        Ok(Outcome::Done) => 0,
        Ok(Outcome::Partial) => 3,
        Err(error) => {
            say_error(&error);
            if error.is::<UsageError>() { 2 } else { 1 }
        }
    }
}

/// What is wrong with what was typed: how it is used, and the error as the last line, as of all that fails.
fn say_usage(error: &clap::Error) {
    let text = error.render().to_string();
    match text.split_once("\n\n").filter(|(head, _)| head.starts_with("error:")) {
        Some((head, usage)) => {
            progress::say(usage.trim_end());
            progress::say(&text::in_a_line(head));
        }
        // What was asked for by --help is no failure. Whoever reads it may have enough of it.
        None => drop(error.print()),
    }
}

/// What failed: the lines of a file that a parser shows, then the error as one line.
fn say_error(error: &anyhow::Error) {
    let (shown, told) = text::without_shown_lines(&format!("{error:#}"));
    if !shown.is_empty() {
        progress::say(&shown);
    }
    progress::say(&format!("error: {told}"));
}
