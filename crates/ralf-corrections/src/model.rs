//! Edits: who makes them, and what they ask for.

use crate::content::{ContentHash, ScanContent};
use std::fmt;

/// Which scan of which radar of which sequence. Ordered by these.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct ScanKey {
    /// The sequence's name.
    pub sequence: String,
    /// The radar's name.
    pub radar: String,
    /// The scan's number.
    pub scan: u32,
}

impl fmt::Display for ScanKey {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}/{:06}", self.sequence, self.radar, self.scan)
    }
}

/// Who edits, from where, and under which name the edit is known.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Who {
    /// The person: undo and redo belong to it. The same for ever, whatever the person is called.
    pub author: String,
    /// What others read of the person.
    pub name: String,
    /// Whether the person said so. A name that it didn't say counts until it says one, and never in place of another.
    pub is_named: bool,
    /// The window it works in: its own edits are no news to it.
    pub tab: Option<String>,
    /// Names this edit alone. One that was made already is not made again, and answered as the first time:
    /// whoever lost the answer may ask again.
    pub edit: Option<String>,
}

impl Who {
    /// A person that is known by its name alone.
    pub fn named(name: &str) -> Self {
        Self { author: name.to_owned(), name: name.to_owned(), is_named: true, tab: None, edit: None }
    }
}

/// One label for detections of scans of one sequence, given in one movement.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Stroke {
    /// The sequence's name.
    pub sequence: String,
    /// The tool's name, such as `lasso`.
    pub tool: String,
    /// Strokes with the same group are undone and redone together, but for those that the author did something upon
    /// between them.
    pub group: Option<String>,
    /// Leave detections as they are that a person has corrected before.
    pub protect: bool,
    /// Write down detections that have this label already, too: somebody looked, and said the same.
    pub confirm: bool,
    /// SemanticKITTI id; `None` takes corrections away.
    pub label: Option<u16>,
    /// Why it is so. Detections that have the label already are told the cause, too.
    pub cause: Option<String>,
    /// The detections.
    pub scans: Vec<ScanEdit>,
}

impl Stroke {
    /// A stroke that does nothing, to be filled.
    pub fn of_sequence(name: &str) -> Self {
        Self { sequence: name.to_owned(), ..Self::default() }
    }
}

/// A stroke's part in one scan.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ScanEdit {
    /// The radar's name.
    pub radar: String,
    /// The scan's number.
    pub scan: u32,
    /// How many detections the scan has.
    pub detections: u32,
    /// What it holds, where that is known.
    pub content: Option<ContentHash>,
    /// The revision that the author saw.
    pub base: u64,
    /// Which detections, by their place in the scan.
    pub points: Vec<u32>,
}

impl ScanEdit {
    pub(crate) fn version(&self, sequence: &str) -> ScanVersion {
        let key = ScanKey { sequence: sequence.to_owned(), radar: self.radar.clone(), scan: self.scan };
        ScanVersion { key, content: ScanContent { detections: self.detections, hash: self.content } }
    }
}

/// A mark of review to be set or taken away.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mark {
    /// The scan.
    pub key: ScanKey,
    /// What it holds, where that is known.
    pub content: Option<ContentHash>,
    /// The revision that the author saw.
    pub base: u64,
    /// The machine's labels (SemanticKITTI ids), one per detection.
    pub machine: Vec<u16>,
    /// Whether the mark is to be there.
    pub reviewed: bool,
}

/// A scan, and what it holds.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanVersion {
    /// Which scan.
    pub key: ScanKey,
    /// What it holds.
    pub content: ScanContent,
}
