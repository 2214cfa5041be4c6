//! Who labels what, and in whose file it is written.

use crate::error::ReviewError;
use ralf::sensors::Sequence;
use ralf_corrections::FILE;
use ralf_data::result::{RadarScanKey, SequenceRecord};
use ralf_data::team::{Assignment, Twice, second_file};
use ralf_data::{DataError, ScanId, ScanIndex};
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
        let assignment = Assignment::open(out, labelled)?;
        // As people are called everywhere else; a name that no file can have is refused with its file.
        let second = second.map(|name| name.trim().to_owned());
        if let (Some(dealt), Some(name)) = (&assignment, &second) {
            dealt.check_known(out, name)?;
        }
        Ok(Self { assignment, second })
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

    /// Which scans of a sequence somebody is asked about here: all, but for who labels a second time and was dealt
    /// some.
    pub(crate) fn asks<'a>(&'a self, sequence: &'a Sequence) -> impl Fn(ScanIndex) -> bool + 'a {
        let twice = self.second.as_ref().and_then(|name| self.twice_of(name));
        move |ScanIndex { radar, scan }| {
            twice.as_ref().is_none_or(|twice| {
                let radar = sequence.rig.radars[radar].name.clone();
                let number = u32::try_from(scan);
                number.is_ok_and(|scan| twice.holds(&ScanId { sequence: sequence.name.clone(), radar, scan }))
            })
        }
    }

    /// What somebody labels a second time; `None` where nobody has dealt anything to that name.
    pub(crate) fn twice_of(&self, name: &str) -> Option<Twice<'_>> {
        self.assignment.as_ref()?.twice_of(name)
    }

    /// The scans of a sequence that somebody is to label a second time; `None` where none were dealt in any.
    pub(crate) fn twice(&self, sequence: &str) -> Option<BTreeSet<RadarScanKey>> {
        let mut dealt = self.assignment.as_ref()?.0.values().flat_map(|share| &share.twice).peekable();
        dealt.peek()?;
        Some(scans(dealt, sequence))
    }
}

fn scans<'a>(all: impl Iterator<Item = &'a ScanId>, sequence: &str) -> BTreeSet<RadarScanKey> {
    let own = all.filter(|scan| scan.sequence == sequence);
    own.map(|scan| RadarScanKey::new(&scan.radar, scan.scan as usize)).collect()
}
