//! Who labels what, and in whose file it is written.

use crate::error::ReviewError;
use ralf_corrections::FILE;
use ralf_data::DataError;
use ralf_data::result::{RadarScanKey, SequenceRecord};
use ralf_data::team::{Assignment, second_file};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The people who work on these labels, as far as somebody has said who they are.
pub(crate) struct Team {
    assignment: Option<Assignment>,
    /// Who labels a second time here, and sees nothing that others said.
    pub(crate) second: Option<String>,
}

impl Team {
    /// Of labelled sequences.
    pub(crate) fn open(
        out: &Path,
        labelled: &[SequenceRecord],
        second: Option<String>,
    ) -> Result<Self, ReviewError> {
        Ok(Self { assignment: Assignment::open(out, labelled)?, second })
    }

    /// Where edits are written. Nobody else's file is ever opened for who labels a second time.
    pub(crate) fn store(&self, out: &Path) -> Result<PathBuf, DataError> {
        let Some(name) = &self.second else { return Ok(out.join(FILE)) };
        let file = second_file(out, name)?;
        let folder = file.parent().unwrap_or(out);
        // Where it can't be made, opening the store says so.
        let _there_or_not = fs::create_dir_all(folder);
        Ok(file)
    }

    /// The people by name.
    pub(crate) fn people(&self) -> Vec<&str> {
        self.assignment.iter().flat_map(|dealt| dealt.0.keys().map(String::as_str)).collect()
    }

    /// Who labels a sequence.
    pub(crate) fn of_sequence(&self, name: &str) -> Option<&str> {
        self.assignment.as_ref()?.of_sequence(name)
    }

    /// The scans of a sequence that the queue is about; `None`: all of them, as for who labels a
    /// second time and was dealt no scans in any sequence.
    pub(crate) fn queued(&self, sequence: &str) -> Option<BTreeSet<RadarScanKey>> {
        let share = self.assignment.as_ref()?.0.get(self.second.as_ref()?)?;
        (!share.twice.is_empty()).then(|| scans(share.twice.iter(), sequence))
    }

    /// The scans of a sequence that somebody is to label a second time; `None` where none were dealt in any.
    pub(crate) fn twice(&self, sequence: &str) -> Option<BTreeSet<RadarScanKey>> {
        let mut dealt = self.assignment.as_ref()?.0.values().flat_map(|share| &share.twice).peekable();
        dealt.peek()?;
        Some(scans(dealt, sequence))
    }
}

fn scans<'a>(all: impl Iterator<Item = &'a ralf_data::ScanId>, sequence: &str) -> BTreeSet<RadarScanKey> {
    let own = all.filter(|scan| scan.sequence == sequence);
    own.map(|scan| RadarScanKey::new(&scan.radar, scan.scan as usize)).collect()
}
