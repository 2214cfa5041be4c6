//! What becomes of edits.

use crate::content::ContentHash;
use crate::model::ScanKey;

/// What came of an edit.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome {
    /// It is on disk.
    Done(Edit),
    /// Another edit came first; nothing was written.
    Conflict(Conflict),
}

/// An edit that is on disk.
#[derive(Debug, Clone, PartialEq)]
pub struct Edit {
    /// The (last) stroke's number; `None` where nothing was to be done.
    pub stroke: Option<i64>,
    /// How many corrections and marks are others than before.
    pub changed: u64,
    /// The scans concerned, as they are now, with the revision that the edit led to; in the order of their keys.
    pub scans: Vec<ScanState>,
    /// What the author can undo and redo in the sequence now.
    pub history: History,
}

/// Whose edit came first.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Conflict {
    /// The other edit's author, by name; empty, as time and tool are, where there is none: the edit was made on a
    /// revision that the scan never had.
    pub author: String,
    /// When it was made, ISO 8601 in UTC.
    pub at: String,
    /// Its tool; `undo`, `redo`, `reviewed` and `unreviewed` are such.
    pub tool: String,
    /// Where the edits meet.
    pub radar: String,
    /// Where the edits meet.
    pub scan: u32,
    /// The scans that were to be edited, as they are now, in the order of their keys.
    pub scans: Vec<ScanState>,
}

/// What is said of one scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanState {
    /// Which scan.
    pub key: ScanKey,
    /// What it held when something was said of it first, where that is known.
    pub content: Option<ContentHash>,
    /// How often its corrections changed; 0 is never.
    pub revision: u64,
    /// Detections that a person has labelled, ascending, with the label's id.
    pub corrections: Vec<(u32, u16)>,
    /// Of these the ones whose cause somebody has said, ascending.
    pub causes: Vec<(u32, String)>,
    /// Where a person has marked the scan.
    pub review: Option<Review>,
}

/// A mark of review.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Review {
    /// Who marked the scan, by name.
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

/// A stroke, a group of them, or a mark of review set or taken away.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// The tool of its last stroke; `reviewed` or `unreviewed` of a mark.
    pub tool: String,
    /// The label of its last stroke; `None` took corrections away.
    pub label: Option<u16>,
    /// Corrections and marks that it changed.
    pub changed: u64,
    /// When its last stroke was made, ISO 8601 in UTC.
    pub at: String,
}
