//! A recording's sequences, opened one by one.

use crate::error::DataError;
use crate::read::incomplete::{Incomplete, Lost, whole};
use crate::read::{Recording, SequenceReader};
use std::path::Path;

/// What was found of a recording's sequences, in their order: those that could be opened, and the others.
#[derive(Default)]
pub(crate) struct Opened {
    pub(crate) sequences: Vec<Box<dyn SequenceReader>>,
    pub(crate) incomplete: Vec<Incomplete>,
}

impl Opened {
    /// Opens what was found under each name: only what these names ask for, where all of them are there. What they ask
    /// for has to be right; else what is wrong with one sequence costs the others nothing.
    pub(crate) fn of<T, R: SequenceReader + 'static>(
        found: Vec<(String, T)>,
        names: &[String],
        mut open: impl FnMut(&str, T) -> Result<R, DataError>,
    ) -> Result<Self, DataError> {
        let is_there = |name: &String| found.iter().any(|(known, _)| known == name);
        let is_chosen = !names.is_empty() && names.iter().all(is_there);
        let mut opened = Self::default();
        for (name, place) in found {
            if is_chosen && !names.contains(&name) {
                continue;
            }
            match open(&name, place) {
                Ok(reader) => opened.sequences.push(Box::new(reader)),
                Err(error) if is_chosen => return Err(error),
                Err(error) => opened.lose(name, error),
            }
        }
        opened.or_first_error()
    }

    /// What was opened as a recording, with sequences that lack parts.
    pub(crate) fn recording(
        mut self,
        path: &Path,
        format: &'static str,
        lacking: Vec<Incomplete>,
    ) -> Recording {
        self.incomplete.extend(lacking);
        self.incomplete.sort_by(|a, b| a.name.cmp(&b.name));
        let Self { sequences, incomplete } = self;
        Recording { incomplete, ..Recording::new(path, format, sequences) }
    }

    /// Counts a sequence as one that was refused.
    pub(crate) fn lose(&mut self, name: String, error: DataError) {
        self.incomplete.push(Incomplete { name, lost: Lost::Refused(error) });
    }

    /// What can be read, or the first reason where nothing can be.
    pub(crate) fn or_first_error(mut self) -> Result<Self, DataError> {
        self.incomplete.sort_by(|a, b| a.name.cmp(&b.name));
        if self.sequences.is_empty() {
            whole(self.incomplete).map(|incomplete| Self { incomplete, ..self })
        } else {
            Ok(self)
        }
    }
}
