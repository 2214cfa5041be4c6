//! The command `ralf`.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(ralf_cli::run(std::env::args_os()))
}
