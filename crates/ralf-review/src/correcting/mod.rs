//! Edits: from requests to the store, and back.

mod answers;
mod changes;
mod reviewed;
mod strokes;

pub(crate) use changes::{Since, changes};
pub(crate) use reviewed::{MarkRequest, mark};
pub(crate) use strokes::{StepRequest, StrokeRequest, history, redo, stroke, undo};
