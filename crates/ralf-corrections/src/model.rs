//! Strokes and what becomes of them.

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

/// Who edits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Who {
    /// The person: undo and redo belong to it.
    pub author: String,
    /// The window it works in: its own edits are no news to it.
    pub tab: Option<String>,
}

/// One label for detections of scans of one sequence, given in one movement.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Stroke {
    /// The sequence's name.
    pub sequence: String,
    /// The tool's name, such as `lasso`.
    pub tool: String,
    /// Strokes in a row with the same group are undone and redone together.
    pub group: Option<String>,
    /// Leave detections as they are that a person has corrected before.
    pub protect: bool,
    /// SemanticKITTI id; `None` takes corrections away.
    pub label: Option<u16>,
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
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanEdit {
    /// The radar's name.
    pub radar: String,
    /// The scan's number.
    pub scan: u32,
    /// How many detections the scan has.
    pub detections: u32,
    /// The revision that the author saw.
    pub base: u64,
    /// Which detections, by their place in the scan.
    pub points: Vec<u32>,
}

/// What came of an edit.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome<T = Edit> {
    /// It is on disk.
    Done(T),
    /// Another edit came first; nothing was written.
    Conflict(Conflict),
}

/// An edit that is on disk.
#[derive(Debug, Clone, PartialEq)]
pub struct Edit {
    /// The (last) stroke's number; `None` where nothing was to be done.
    pub stroke: Option<i64>,
    /// How many detections have another correction than before.
    pub changed: u64,
    /// The scans concerned, as they are now, by radar and scan.
    pub scans: Vec<ScanState>,
    /// What the author can undo and redo in the sequence now.
    pub history: History,
}

/// Whose edit came first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Conflict {
    /// The other edit's author.
    pub author: String,
    /// When it was made, ISO 8601 in UTC.
    pub at: String,
    /// Its tool; `undo` and `redo` are such.
    pub tool: String,
    /// Where the edits meet.
    pub radar: String,
    /// Where the edits meet.
    pub scan: u32,
    /// The scans that were to be edited, as they are now, by radar and scan.
    pub scans: Vec<ScanState>,
}

/// The corrections of one scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanState {
    /// Which scan.
    pub key: ScanKey,
    /// How often its corrections changed; 0 is never.
    pub revision: u64,
    /// Detections that a person has labelled, ascending, with the label's id.
    pub corrections: Vec<(u32, u16)>,
    /// Where a person has marked the scan.
    pub review: Option<Review>,
}

/// A reviewed mark.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Review {
    /// Who marked the scan.
    pub author: String,
    /// When, ISO 8601 in UTC.
    pub at: String,
    /// The machine's labels (SemanticKITTI ids) at that moment, one per detection.
    pub accepted: Vec<u16>,
}

/// What an author can take back and set again in a sequence.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct History {
    /// The step that undo would take back.
    pub undo: Option<Step>,
    /// The step that redo would set again.
    pub redo: Option<Step>,
    /// Steps that can be undone.
    pub undo_depth: u64,
    /// Steps that can be redone.
    pub redo_depth: u64,
}

/// A stroke, or a group of them.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// Of its last stroke.
    pub tool: String,
    /// Of its last stroke; `None` took corrections away.
    pub label: Option<u16>,
    /// Corrections that it changed.
    pub changed: u64,
    /// When its last stroke was made, ISO 8601 in UTC.
    pub at: String,
}
