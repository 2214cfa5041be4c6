//! `ralf._ralf`: what the Python package `ralf` is made of. It is thin: settings, recordings and records cross as JSON,
//! columns as memory that both sides see. The package itself, typed and for people, lies in `python/ralf`.

mod arrays;
mod errors;
mod evaluation;
mod labelling;
mod memory;
mod pictures;
mod recording;
mod table;
mod watch;

use pyo3::prelude::*;
use std::ffi::OsString;

/// The command `ralf`. Returns its exit status.
#[pyfunction]
fn command(py: Python<'_>, typed: Vec<OsString>) -> u8 {
    py.detach(|| ralf_cli::run(typed))
}

/// What the Python package `ralf` is made of.
#[pymodule]
mod _ralf {
    #[pymodule_export]
    use super::arrays::Column;
    #[pymodule_export]
    use super::command;
    #[pymodule_export]
    use super::errors::RalfError;
    #[pymodule_export]
    use super::evaluation::{Truth, evaluate, is_corrected};
    #[pymodule_export]
    use super::labelling::{
        assemble, columns, folders, label, label_one, plan, planned, record, settings, table,
    };
    #[pymodule_export]
    use super::memory::MemorySequence;
    #[pymodule_export]
    use super::pictures::plot;
    #[pymodule_export]
    use super::recording::Recording;
    #[pymodule_export]
    use super::table::Table;
}
