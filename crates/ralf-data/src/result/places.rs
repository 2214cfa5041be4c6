//! Where the results of a run lie: the one place that knows.

use super::{Component, OutFolder};
use crate::tree::{self, RECORD, SEQUENCES, TABLE};
use std::path::{Path, PathBuf};

/// An output folder of `ralf label`.
#[derive(Debug, Clone)]
pub struct Places {
    out: OutFolder,
}

impl Places {
    /// Those in an output folder.
    pub fn new(out: &Path) -> Self {
        Self { out: OutFolder::new(out) }
    }

    /// The record of the run.
    pub fn record_file(&self) -> PathBuf {
        self.out.own_file(RECORD)
    }

    /// The folder of a sequence.
    pub(crate) fn folder(&self, sequence: &Component) -> OutFolder {
        self.out.own(SEQUENCES).folder(sequence)
    }

    /// The table of a sequence.
    pub fn plausibility_file(&self, sequence: &Component) -> PathBuf {
        self.folder(sequence).own_file(TABLE)
    }

    /// The labels of a scan.
    pub(crate) fn label_file(&self, sequence: &Component, radar: &Component, scan: usize) -> PathBuf {
        tree::label_file(self.out.path(), sequence.as_str(), radar.as_str(), scan)
    }
}
