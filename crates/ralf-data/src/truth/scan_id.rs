//! Which scan, and where its labels lie.

use crate::frames::ScanIndex;
use crate::tree;
use ralf::sensors::Sequence;
use std::fmt;
use std::path::{Path, PathBuf};

/// Which scan of which radar of which sequence. Ordered by these.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct ScanId {
    /// The sequence's folder.
    pub sequence: String,
    /// The radar's folder.
    pub radar: String,
    /// The number in the file's name.
    pub scan: u32,
}

impl ScanId {
    /// Where the labels that a run gave this scan lie below its folder.
    pub fn label_file(&self, out: &Path) -> PathBuf {
        tree::label_file(out, &self.sequence, &self.radar, self.scan as usize)
    }

    /// Where it lies in its sequence; `None` where it isn't there.
    pub fn place_in(&self, sequence: &Sequence) -> Option<ScanIndex> {
        let radar = sequence.rig.radars.iter().position(|radar| radar.name == self.radar)?;
        let (scan, times) = (self.scan as usize, sequence.times.radars.get(radar)?);
        (self.sequence == sequence.name && scan < times.len()).then_some(ScanIndex { radar, scan })
    }

    /// Where its corrected labels lie below the dataset's folder.
    pub fn truth_file(&self, dataset: &Path) -> PathBuf {
        tree::truth_file(dataset, &self.sequence, &self.radar, self.scan as usize)
    }
}

impl fmt::Display for ScanId {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}/{}/{:06}", self.sequence, self.radar, self.scan)
    }
}
