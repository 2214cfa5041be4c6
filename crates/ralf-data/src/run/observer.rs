//! Who is told how a run gets on.

use super::earlier::Earlier;
use std::time::Duration;

/// Part of the work, for a progress display.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stage<'a> {
    /// Hashing the input files; counted in bytes.
    Inputs,
    /// Matching a sequence's scans for tuning; counted in scans.
    Matching(&'a str),
    /// Gathering a sequence's evidence for learning; counted in scans.
    Gathering(&'a str),
    /// Labelling a sequence, or several, which this then tells; counted in scans.
    Labelling(&'a str),
    /// Writing a sequence's result when all are labelled; counted in scans.
    Writing(&'a str),
}

/// Part of what a worker does for a scan or a sequence, for whoever counts where time goes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// Checking a sequence: told once for each.
    Checking,
    /// Reading what belongs to a scan, with what scans share: the ground, calibrated images.
    Gathering,
    /// Gathering its evidence, where that is asked for.
    Evidence,
    /// Labelling it.
    Labelling,
    /// Keeping its table until the sequence is complete.
    Keeping,
    /// Putting a sequence's scans together: told once for each sequence.
    Writing,
}

/// Is told how a run gets on. Called from several threads.
pub trait Observer: Sync {
    /// Results lay in the output folder, of which this has become: told before anything is labelled, for whoever ends
    /// the run then has lost them all the same.
    fn found(&self, _earlier: &Earlier) {}
    /// A stage of so many steps begins.
    fn begin(&self, _stage: Stage, _steps: u64) {}
    /// Some more steps of the stage are done, with so many detections in them.
    fn advance(&self, _steps: u64, _detections: u64) {}
    /// The stage is over.
    fn end(&self) {}
    /// A worker was so long at a part of a scan.
    fn spent(&self, _part: Part, _time: Duration) {}
    /// Whether somebody wants the work to end: it then ends with [`DataError::Stopped`](crate::DataError::Stopped), and
    /// what is done is kept.
    fn stopped(&self) -> bool {
        false
    }
}

/// Is told, and tells nobody.
#[derive(Debug, Clone, Copy)]
pub struct Unwatched;

impl Observer for Unwatched {}
