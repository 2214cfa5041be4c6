//! The command line of RALF.

mod commands;

use clap::Parser;
use commands::Outcome;
use std::io::Write;
use std::process::ExitCode;

/// Which radar detections are real?
#[derive(Debug, Parser)]
#[command(name = "ralf", version)]
enum Command {
    /// Compare labels with corrected ones.
    Evaluate(commands::evaluate::EvaluateArgs),
}

fn main() -> ExitCode {
    let Command::Evaluate(args) = Command::parse();
    match commands::evaluate::run(&args) {
        Ok(Outcome::Done) => ExitCode::SUCCESS,
        Ok(Outcome::Partial) => ExitCode::from(3),
        Err(error) => {
            // Nobody is left to tell when standard error is closed.
            let _ = writeln!(std::io::stderr(), "error: {error:#}");
            ExitCode::FAILURE
        }
    }
}
