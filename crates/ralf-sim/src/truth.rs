//! The truth by the paper's labelling policy: it follows from what sent an echo, and never from what LiDAR or camera
//! see.

use ralf::label::Cause;

/// What is true of a detection.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Truth {
    /// SemanticKITTI id; 1 of every artifact.
    pub class: u16,
    /// Why it is an artifact, if it is one.
    pub cause: Cause,
}

impl Truth {
    /// An artifact.
    pub(super) fn artifact(cause: Cause) -> Self {
        Self { class: 1, cause }
    }
}
