//! What is known of an error beside its sentence.

use ralf_data::DataError;
use std::path::Path;

/// File, place, expected and found, as far as they are known.
#[derive(Default)]
pub(super) struct Details {
    pub(super) file: Option<String>,
    pub(super) place: Option<String>,
    pub(super) expected: Option<String>,
    pub(super) found: Option<String>,
}

impl Details {
    pub(super) fn of(error: &DataError) -> Self {
        match error {
            DataError::Io { file, error } => Self::told(&error.to_string()).in_file(file),
            DataError::Content { file, place, expected, found } => Self {
                place: Some(place.clone()),
                expected: Some(expected.clone()),
                found: Some(found.clone()),
                ..Self::default()
            }
            .in_file(file),
            DataError::Unsuitable { file, place, reason } => Self::told(reason).at(place).in_file(file),
            DataError::UnknownSequence { name, known } | DataError::NoColumn { name, known } => Self {
                expected: Some(format!("one of {known}")),
                found: Some(name.clone()),
                ..Self::default()
            },
            DataError::Busy { place } => Self::default().in_file(place),
            DataError::Stopped => Self::default(),
            DataError::Measurement { error, .. } => match error.downcast_ref() {
                Some(error) => Self::of(error),
                None => Self::told(&error.to_string()),
            },
            DataError::Corrections(error) => Self::of_file(error.file(), &error.to_string()),
            error => Self::told(&error.to_string()),
        }
    }

    /// What a sentence says that begins with the file, if there is one.
    fn of_file(file: Option<&Path>, sentence: &str) -> Self {
        let Some(file) = file else { return Self::told(sentence) };
        let name = format!("{}: ", file.display());
        Self::told(sentence.strip_prefix(&name).unwrap_or(sentence)).in_file(file)
    }

    /// What a sentence says. All of ours have one form, `place: expected this, found that`, wherever they were made:
    /// many libraries tell them as text alone. A parser's are over several lines, and what was found stands before
    /// what was expected. Any other says what was found.
    pub(super) fn told(sentence: &str) -> Self {
        const EXPECTED: &str = "expected ";
        let (place, core) = in_parts(sentence);
        let (expected, found) = match (core.strip_prefix(EXPECTED), core.split_once(&format!(": {EXPECTED}")))
        {
            (Some(rest), _) => halves(rest),
            (None, Some((before, rest))) => {
                let (expected, found) = halves(rest);
                return Self { expected, found, ..Self::default() }.at(before);
            }
            (None, None) => match core.split_once(&format!(", {EXPECTED}")) {
                Some((found, expected)) => (Some(expected.to_owned()), Some(found.to_owned())),
                None => (None, Some(core.to_owned())),
            },
        };
        Self { place, expected, found, ..Self::default() }
    }

    pub(super) fn in_file(self, file: &Path) -> Self {
        Self { file: Some(file.display().to_string()), ..self }
    }

    /// The place is in this one.
    fn at(self, place: &str) -> Self {
        let place = match self.place {
            Some(inner) => format!("{place}: {inner}"),
            None => place.to_owned(),
        };
        Self { place: Some(place), ..self }
    }
}

/// What follows `expected`, before and after `, found`.
fn halves(rest: &str) -> (Option<String>, Option<String>) {
    match rest.split_once(", found ") {
        Some((expected, found)) => (Some(expected.to_owned()), Some(found.to_owned())),
        None => (Some(rest.to_owned()), None),
    }
}

/// The place of a parser's message, and its sentence: without the line that it shows.
fn in_parts(message: &str) -> (Option<String>, &str) {
    let mut lines = message.lines().filter(|line| !line.is_empty());
    let Some(first) = lines.next() else { return (None, message) };
    let last = lines.next_back();
    let key = last.and_then(|line| line.strip_prefix("in `")?.strip_suffix('`'));
    match (first.strip_prefix("TOML parse error at "), last, key) {
        (Some(place), Some(last), None) => (Some(place.to_owned()), last),
        (_, _, Some(key)) => (Some(key.to_owned()), first),
        _ => (None, message),
    }
}
