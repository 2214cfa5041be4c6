//! Errors as Python sees them: one exception, with file, place, expected and found where they are known.

mod details;

use details::Details;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use ralf_data::DataError;
use std::fmt::Display;
use std::path::Path;

pyo3::create_exception!(
    ralf._ralf,
    RalfError,
    PyException,
    "What RALF refuses: `file`, `place`, `expected`, `found` say what is wrong where; None where that isn't known."
);

/// An exception of what is wrong with data.
pub(crate) fn data(error: DataError) -> PyErr {
    raise(&error, Details::of(&error))
}

/// An exception of any other error.
pub(crate) fn other(error: impl Display) -> PyErr {
    raise(&error, Details::told(&error.to_string()))
}

/// The same of what a file holds.
pub(crate) fn in_file(file: &Path, error: impl Display) -> PyErr {
    let details = Details::told(&error.to_string());
    raise(&format!("{}: {error}", file.display()), details.in_file(file))
}

fn raise(error: &impl Display, details: Details) -> PyErr {
    let raised = RalfError::new_err(error.to_string());
    Python::attach(|py| {
        let value = raised.value(py);
        let Details { file, place, expected, found } = details;
        let named = [("file", file), ("place", place), ("expected", expected), ("found", found)];
        // An exception of our own takes attributes; that it didn't would be an error of its own.
        let set = named.into_iter().try_for_each(|(name, detail)| value.setattr(name, detail));
        set.err().unwrap_or(raised.clone_ref(py))
    })
}
