//! What tuning and learning had to do without: told of each sequence, as labelling tells it in `run.json`.

use crate::result::{NotLabelled, UnreadableScan};
use ralf::scene::Unreadable;
use std::collections::BTreeSet;

/// What of a sequence was not learned from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NotUsed {
    /// The sequence's name.
    pub sequence: String,
    /// Its radar scans that were left out.
    pub left_out: Vec<NotLabelled>,
    /// Scans of other sensors that can't be read: radar scans near them were matched without.
    pub without: BTreeSet<UnreadableScan>,
}

impl NotUsed {
    /// Nothing yet of a sequence of this name.
    pub(crate) fn of(sequence: &str) -> Self {
        Self { sequence: sequence.to_owned(), left_out: Vec::new(), without: BTreeSet::new() }
    }

    /// Whether all was used.
    pub(crate) fn is_nothing(&self) -> bool {
        self.left_out.is_empty() && self.without.is_empty()
    }

    /// Takes a radar scan's result, if it has one, and what belongs to the scan and can't be read.
    pub(crate) fn sort<T>(&mut self, scan: Result<(T, Vec<Unreadable>), NotLabelled>) -> Option<T> {
        match scan {
            Ok((result, unreadable)) => {
                self.without.extend(unreadable.into_iter().map(UnreadableScan::from));
                Some(result)
            }
            Err(reason) => {
                self.left_out.push(reason);
                None
            }
        }
    }
}
