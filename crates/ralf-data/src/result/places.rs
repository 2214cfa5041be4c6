//! Where the results of a run lie: the one place that knows.

use super::{Component, OutFolder};
use std::path::{Path, PathBuf};

/// The folder `OUT/sequences`.
#[derive(Debug, Clone)]
pub(crate) struct Places {
    sequences: OutFolder,
}

impl Places {
    /// Those in an output folder.
    pub(crate) fn new(out: &Path) -> Self {
        Self { sequences: OutFolder::new(out).own("sequences") }
    }

    /// The folder of a sequence.
    pub(crate) fn folder(&self, sequence: &Component) -> OutFolder {
        self.sequences.folder(sequence)
    }

    /// The table of a sequence.
    pub(crate) fn plausibility_file(&self, sequence: &Component) -> PathBuf {
        self.folder(sequence).own_file("plausibility.parquet")
    }

    /// The labels of a scan.
    pub(crate) fn label_file(&self, sequence: &Component, radar: &Component, scan: usize) -> PathBuf {
        self.folder(sequence).folder(radar).file(&Component::numbered(scan, "label"))
    }
}
