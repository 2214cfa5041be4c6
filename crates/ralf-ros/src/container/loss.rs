//! What of a recording could not be read.

use std::fmt;

/// A part of a recording that could not be read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Loss {
    /// File, place, expected, found: a sentence for people.
    pub sentence: String,
    /// Whether it may have held messages of which nothing else tells: not even their topics are known.
    pub hides_messages: bool,
}

impl Loss {
    /// A part that may have held messages.
    pub(super) fn hiding(sentence: impl Into<String>) -> Self {
        Self { sentence: sentence.into(), hides_messages: true }
    }
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}
