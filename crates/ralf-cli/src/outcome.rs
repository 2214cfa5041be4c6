//! How a command ends.

use crate::progress::say;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether a sequence of a recording was left out, for it can't be read. Every command opens recordings, and none can
/// say of such a one that all is done.
static LEFT_OUT: AtomicBool = AtomicBool::new(false);

/// Names a sequence that can't be read and was left out, with the reason.
pub(crate) fn say_left_out(named: &str) {
    say(&format!("left out: {named}"));
    LEFT_OUT.store(true, Ordering::Relaxed);
}

/// How a command ended, once it is known whether it left a sequence out.
pub(crate) fn at_the_end(outcome: Outcome) -> Outcome {
    outcome.and(Outcome::done_if(!LEFT_OUT.swap(false, Ordering::Relaxed)))
}

/// How a command ended that did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All of it.
    Done,
    /// Some sequences, scans, or corrections of some, are left out; each was named.
    Partial,
}

impl Outcome {
    /// How it ended where nothing, or something, is left out.
    pub(crate) fn done_if(complete: bool) -> Self {
        if complete { Self::Done } else { Self::Partial }
    }

    /// How both ended together.
    pub(crate) fn and(self, other: Self) -> Self {
        if self == Self::Done { other } else { self }
    }
}

/// The user asked for something that doesn't exist.
#[derive(Debug)]
pub(crate) struct UsageError(pub(crate) String);

impl std::fmt::Display for UsageError {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for UsageError {}
