//! What of a recording could not be read.

use std::collections::BTreeMap;
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

    /// Each once: a chunk is looked into for its channels, and for its messages where no index tells of them.
    pub(super) fn once(losses: Vec<Self>) -> Vec<Self> {
        let (mut once, mut places): (Vec<Self>, BTreeMap<String, usize>) = (Vec::new(), BTreeMap::new());
        for loss in losses {
            match places.get(&loss.sentence) {
                Some(place) => once[*place].hides_messages |= loss.hides_messages,
                None => {
                    places.insert(loss.sentence.clone(), once.len());
                    once.push(loss);
                }
            }
        }
        once
    }
}

impl fmt::Display for Loss {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}
