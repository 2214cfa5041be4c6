//! One module per verb: thin, for what they do is done by the libraries.

pub(crate) mod convert;
pub(crate) mod evaluate;
pub(crate) mod inspect;
pub(crate) mod label;
pub(crate) mod plot;
pub(crate) mod simulate;

use crate::Outcome;
use crate::cli::{Cli, Command};
use clap::CommandFactory;

/// Runs what was typed.
pub(crate) fn dispatch(arguments: Cli) -> anyhow::Result<Outcome> {
    match arguments.command {
        Command::Inspect(arguments) => inspect::run(&arguments),
        Command::Label(arguments) => label::run(&arguments),
        Command::Evaluate(arguments) => evaluate::run(&arguments),
        Command::Plot(arguments) => plot::run(&arguments),
        Command::Convert(arguments) => convert::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments),
        Command::Completions { shell } => {
            clap_complete::generate(shell, &mut Cli::command(), "ralf", &mut std::io::stdout());
            Ok(Outcome::Done)
        }
    }
}
