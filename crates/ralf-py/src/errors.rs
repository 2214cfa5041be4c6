//! Errors as Python sees them: one exception, with file, place, expected and found where they are known.

use pyo3::exceptions::PyException;
use pyo3::prelude::*;
use ralf_data::DataError;
use std::fmt::Display;

pyo3::create_exception!(
    ralf._ralf,
    RalfError,
    PyException,
    "What RALF refuses: `file`, `place`, `expected`, `found` say what is wrong where; None where that isn't known."
);

/// What is known of an error beside its sentence.
#[derive(Default)]
struct Details {
    file: Option<String>,
    place: Option<String>,
    expected: Option<String>,
    found: Option<String>,
}

impl Details {
    fn of(error: &DataError) -> Self {
        let text = |path: &std::path::Path| Some(path.display().to_string());
        match error {
            DataError::Io { file, error } => {
                Self { file: text(file), found: Some(error.to_string()), ..Self::default() }
            }
            DataError::Content { file, place, expected, found } => Self {
                file: text(file),
                place: Some(place.clone()),
                expected: Some(expected.clone()),
                found: Some(found.clone()),
            },
            DataError::Unsuitable { file, place, reason } => Self {
                file: text(file),
                place: Some(place.clone()),
                found: Some(reason.clone()),
                ..Self::default()
            },
            DataError::UnknownSequence { name, known } | DataError::NoColumn { name, known } => Self {
                expected: Some(format!("one of {known}")),
                found: Some(name.clone()),
                ..Self::default()
            },
            DataError::Busy { place } => Self { file: text(place), ..Self::default() },
            DataError::Measurement { error, .. } => error.downcast_ref().map(Self::of).unwrap_or_default(),
            _ => Self::default(),
        }
    }
}

/// An exception of what is wrong with data.
pub(crate) fn data(error: DataError) -> PyErr {
    raise(&error, Details::of(&error))
}

/// An exception of any other error.
pub(crate) fn other(error: impl Display) -> PyErr {
    raise(&error, Details::default())
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
