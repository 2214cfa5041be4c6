//! What becomes of results that lie in the output folder already.

use crate::result::UnreadableScan;
use std::path::PathBuf;

/// Why results are gone.
const OTHERS: &str = "made by another version, of a recording of another format or with other settings";

/// What became of the results that lay in the output folder, by sequence.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Earlier {
    /// Their labels are gone, for they were made by another version of the program, with other settings or of a
    /// recording of another format.
    pub removed: Vec<String>,
    /// The same of labels that a run has made which isn't over: of some scans, maybe not of all.
    pub unfinished: Vec<String>,
    /// The labels of these are gone for the reason of [`removed`](Self::removed), and the run that found them has
    /// labelled the sequences again.
    pub replaced: Vec<String>,
    /// They are to be labelled again, for what they are read from is not what it was.
    pub changed: Vec<String>,
    /// They are to be labelled again, for this file, the first such, is not as it was written.
    pub damaged: Vec<(String, PathBuf)>,
    /// They are to be labelled again, for they were labelled without this, which can be read now or can't for another
    /// reason.
    pub without: Vec<(String, UnreadableScan)>,
}

impl Earlier {
    /// A sequence that has to be is labelled at once, in the words of [`told`](Self::told).
    pub const NOW: &str = "is labelled again";
    /// It is planned to be.
    pub const PLANNED: &str = "is to be labelled again";

    /// What became of them, for people: a sentence each, what is gone first. `again` is [`NOW`](Self::NOW) or
    /// [`PLANNED`](Self::PLANNED).
    pub fn told(&self, again: &str) -> Vec<String> {
        let others = |done: &str, what: &str, names: &[String]| {
            (!names.is_empty()).then(|| format!("{done}, for they were {OTHERS}: {what}{}", names.join(", ")))
        };
        let changed = self
            .changed
            .iter()
            .map(|sequence| format!("sequence {sequence} {again}: it is read from other inputs than before"));
        let damaged = self.damaged.iter().map(|(sequence, file)| {
            format!("sequence {sequence} {again}: {} is not as it was written", file.display())
        });
        let without = self.without.iter().map(|(sequence, UnreadableScan { sensor, scan, .. })| {
            format!(
                "sequence {sequence} {again}, for it was labelled without {sensor} {scan}, which could not be \
                 read then"
            )
        });
        let removed = others("removed", "", &self.removed);
        let unfinished = others("removed", "what was labelled so far of ", &self.unfinished);
        let replaced = others("labelled again", "", &self.replaced);
        removed
            .into_iter()
            .chain(unfinished)
            .chain(replaced)
            .chain(changed)
            .chain(damaged)
            .chain(without)
            .collect()
    }

    /// What is gone, too; each is named once.
    pub(super) fn add(&mut self, more: Self) {
        self.removed.extend(more.removed);
        self.unfinished.extend(more.unfinished);
        for names in [&mut self.removed, &mut self.unfinished] {
            names.sort();
            names.dedup();
        }
        self.unfinished.retain(|name| !self.removed.contains(name));
    }

    /// The same where the sequences of these names are labelled at once.
    pub(super) fn and_labelled(mut self, names: &[String]) -> Self {
        let is_labelled = |name: &mut String| names.contains(name);
        self.replaced.extend(self.removed.extract_if(.., is_labelled));
        self.unfinished.retain(|name| !names.contains(name));
        self
    }
}
