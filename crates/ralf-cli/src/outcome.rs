//! How a command ends.

/// How a command ended that did not fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All of it.
    Done,
    /// Some scans, or corrections of some, are left out; each was named.
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
