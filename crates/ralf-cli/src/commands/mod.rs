//! One module per verb: its arguments and `run`.

pub(crate) mod evaluate;

/// How a command ended that didn't fail.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Outcome {
    /// All of it was done.
    Done,
    /// Done, but for some scans, which were named.
    Partial,
}
