//! One module per verb: thin, for what they do is done by the libraries.

pub(crate) mod ablate;
pub(crate) mod check;
pub(crate) mod convert;
pub(crate) mod demo;
pub(crate) mod depth;
pub(crate) mod evaluate;
pub(crate) mod export;
pub(crate) mod inspect;
pub(crate) mod label;
pub(crate) mod plot;
pub(crate) mod report;
pub(crate) mod review;
mod search;
pub(crate) mod simulate;
pub(crate) mod tune;

use crate::Outcome;
use crate::cli::{Cli, Command};
use crate::text::print;
use clap::CommandFactory;

/// Runs what was typed.
pub(crate) fn dispatch(arguments: Cli) -> anyhow::Result<Outcome> {
    match arguments.command {
        Command::Demo(arguments) => demo::run(&arguments),
        Command::Inspect(arguments) => inspect::run(&arguments),
        Command::Check(arguments) => check::run(&arguments),
        Command::Label(arguments) => label::run(&arguments),
        Command::Evaluate(arguments) => evaluate::run(&arguments),
        Command::Plot(arguments) => plot::run(&arguments),
        Command::Report(arguments) => report::run(&arguments),
        Command::Review(arguments) => review::run(&arguments),
        Command::Export(arguments) => export::run(&arguments),
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Depth(arguments) => depth::run(&arguments),
        Command::Tune(arguments) => tune::run(&arguments),
        Command::Ablate(arguments) => ablate::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Cli::command(), "ralf", &mut script);
            print(&String::from_utf8_lossy(&script)).map(|()| Outcome::Done)
        }
    }
}
