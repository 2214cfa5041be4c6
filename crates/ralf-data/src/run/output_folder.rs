//! The output folder: results belong to sequences, and those of one program and the same settings lie side by side.
//!
//! Results go before the records that tell of them, and come before them, so that a kill in between leaves none that
//! nobody knows of. `run.json` comes last: the sequences that it tells of are complete.

use super::earlier::Earlier;
use super::inputs::Identity;
use super::kept::{Finished, Origin, place_of};
use super::not_read;
use super::other_recording::Told;
use super::results::Results;
use super::unfinished::Unfinished;
use super::workspace::Workspace;
use crate::disk::files;
use crate::error::DataError;
use crate::read::Recording;
use crate::result::json::write_json;
use crate::result::{
    CheckRecord, Component, OutFolder, RunRecord, SequenceNames, SequenceRecord, Timings, damaged_result,
    read_record,
};
use crate::tree::RECORD;
use std::path::{Path, PathBuf};

/// The output folder of a run.
pub(super) struct OutputFolder {
    record_file: PathBuf,
    results: Results,
    unfinished: Unfinished,
    /// The sequences that are complete.
    record: RunRecord,
    earlier: Earlier,
}

impl OutputFolder {
    /// Makes the folder ready for a run, whose record is still empty. What has the same version and settings stays,
    /// unless it is asked for and was read from other inputs, or from none, or is not whole; all other results are
    /// removed. Those of another recording are refused; `accepted` is called where there are none, before anything
    /// changes.
    pub(super) fn open(
        out: &Path,
        run: RunRecord,
        recording: &Recording,
        asked: &[Identity],
        accepted: impl FnOnce() -> Result<(), DataError>,
    ) -> Result<Self, DataError> {
        let mut folder = Self::empty(out, run)?;
        let told = Told::read(out, &folder.record)?;
        told.refuse_other_recording(&recording.path, asked)?;
        accepted()?;
        match told.record {
            Some(found) if told.stays => folder.record = found,
            Some(other) => folder.remove_all(&other)?,
            None => {}
        }
        folder.settle(folder.unfinished.finished()?, asked, recording)?;
        let removed = folder.unfinished.remove_outdated(asked, &folder.results)?;
        folder.earlier.add(removed);
        Ok(folder)
    }

    /// The folder where all that is asked for was labelled before, and nothing has to be written; `None` elsewhere.
    /// Nothing is touched.
    pub(super) fn finished(
        out: &Path,
        run: RunRecord,
        recording: &Recording,
        asked: &[Identity],
    ) -> Result<Option<Self>, DataError> {
        let mut folder = Self::empty(out, run)?;
        match read_record(out) {
            Ok(found) if found.is_like(&folder.record) => folder.record = found,
            _ => return Ok(None),
        }
        let is_finished = asked.iter().all(|asked| folder.holds(&asked.name))
            && folder.unfinished.finished()?.is_empty()
            && folder.outdated(asked, recording)?.is_empty();
        Ok(is_finished.then_some(folder))
    }

    fn empty(out: &Path, run: RunRecord) -> Result<Self, DataError> {
        let place = OutFolder::new(out);
        Ok(Self {
            record_file: place.own_file(RECORD),
            results: Results::new(out),
            unfinished: Unfinished::of(&place, &run)?,
            record: run,
            earlier: Earlier::default(),
        })
    }

    /// Removes the results of other settings.
    fn remove_all(&mut self, other: &RunRecord) -> Result<(), DataError> {
        other.sequences.iter().try_for_each(|sequence| self.results.remove(sequence))?;
        self.earlier.removed.extend(other.sequences.iter().map(|sequence| sequence.name.clone()));
        files::remove(&self.record_file)
    }

    /// Adds what killed runs have finished to the record, and takes out of it what is to be labelled again.
    fn settle(
        &mut self,
        finished: Vec<Finished>,
        asked: &[Identity],
        recording: &Recording,
    ) -> Result<(), DataError> {
        let has_moved = self.remember_places(&recording.path, asked);
        let fingerprints: Vec<_> =
            finished.iter().map(|(sequence, _)| sequence.fingerprint.clone()).collect();
        let known = |finished: &Finished| self.record.sequence(&finished.0.name).is_some();
        let new: Vec<_> = finished.into_iter().filter(|finished| !known(finished)).collect();
        self.record.add(new);
        let outdated = self.outdated(asked, recording)?;
        if fingerprints.is_empty() && outdated.is_empty() && !has_moved {
            return Ok(());
        }
        outdated.iter().try_for_each(|sequence| self.results.remove(sequence))?;
        self.record.retain(|sequence| outdated.iter().all(|other| other.name != sequence.name));
        self.write_record()?;
        self.unfinished.forget(fingerprints.iter().map(String::as_str))
    }

    /// Writes down where the recording of what was labelled lies now. Tells whether it has moved.
    fn remember_places(&mut self, recording: &Path, asked: &[Identity]) -> bool {
        let place = place_of(recording);
        let is_asked =
            |known: &SequenceRecord| asked.iter().any(|asked| asked.fingerprint == known.fingerprint);
        let moved =
            self.record.sequences.iter_mut().filter(|known| is_asked(known) && known.recording != place);
        moved.map(|known| known.recording.clone_from(&place)).count() > 0
    }

    /// The sequences that are asked for and have to be labelled again: read from other inputs or from none, damaged, or
    /// labelled without something that is to be had by now.
    fn outdated(
        &mut self,
        asked: &[Identity],
        recording: &Recording,
    ) -> Result<Vec<SequenceRecord>, DataError> {
        let mut outdated = Vec::new();
        for sequence in &self.record.sequences {
            let Some(asked) = asked.iter().find(|asked| asked.name == sequence.name) else { continue };
            if !asked.is_told {
                outdated.push(sequence.clone());
            } else if asked.fingerprint != sequence.fingerprint {
                self.earlier.changed.push(sequence.name.clone());
                outdated.push(sequence.clone());
            } else if let Some(file) = damaged_result(self.results.places(), sequence)? {
                self.earlier.damaged.push((sequence.name.clone(), file));
                outdated.push(sequence.clone());
            } else if let Some(scan) = not_read::changed_since(sequence, recording) {
                self.earlier.without.push((sequence.name.clone(), scan));
                outdated.push(sequence.clone());
            }
        }
        Ok(outdated)
    }

    /// What became of results that lay here.
    pub(super) fn earlier(&self) -> &Earlier {
        &self.earlier
    }

    fn write_record(&self) -> Result<(), DataError> {
        match self.record.sequences.is_empty() {
            true => files::remove(&self.record_file),
            false => write_json(&self.record_file, &self.record),
        }
    }

    /// Whether a sequence was labelled before.
    pub(super) fn holds(&self, name: &str) -> bool {
        self.record.sequence(name).is_some()
    }

    /// Keeps where a sequence that is labelled from now on comes from.
    pub(super) fn begin(&self, fingerprint: &str, origin: &Origin) -> Result<(), DataError> {
        self.unfinished.begin(fingerprint, origin)
    }

    /// Keeps what a sequence is read from, for those that label parts of it.
    pub(super) fn remember(&self, sequence: &Identity, name: &Component) -> Result<(), DataError> {
        self.unfinished.remember(sequence, name)
    }

    /// Where a sequence is labelled.
    pub(super) fn workspace<'a>(
        &'a self,
        sequence: &Identity,
        names: &'a SequenceNames,
    ) -> Result<Workspace<'a>, DataError> {
        let folder = self.unfinished.scans(&sequence.fingerprint, &names.sequence)?;
        Workspace::open(names, folder, &self.results)
    }

    /// A sequence's results are in their places.
    pub(super) fn finish_sequence(&self, finished: &Finished) -> Result<(), DataError> {
        self.unfinished.finish(finished)
    }

    /// All sequences are finished. Returns the record of the folder.
    pub(super) fn finish(
        mut self,
        finished: Vec<Finished>,
        timings: Timings,
        checks: &[CheckRecord],
    ) -> Result<RunRecord, DataError> {
        let fingerprints: Vec<_> =
            finished.iter().map(|(sequence, _)| sequence.fingerprint.clone()).collect();
        let said_before = self.record.check.clone();
        self.record.add(finished);
        self.record.add_checks(checks);
        // A run that was killed may have finished all sequences, and an earlier one may have checked none.
        if !fingerprints.is_empty() || self.record.check != said_before {
            self.record.timings = timings;
            self.write_record()?;
            self.unfinished.forget(fingerprints.iter().map(String::as_str))?;
        }
        Ok(self.record)
    }
}
