//! A run in parts, for several machines that share the output folder.
//!
//! A part is a stretch of a sequence. Labelling one leaves exactly what a run that was killed leaves of these scans, so
//! that putting the parts together is nothing but to let the run go on: its results are those of one machine, to the
//! byte, whatever became of single parts. Every part may be done twice, and by two machines at once.

use super::earlier::Earlier;
use super::kept::Origin;
use super::results::Results;
use super::unfinished::Unfinished;
use super::without::Without;
use super::workers::Labelling;
use super::workspace::Workspace;
use super::{LabelRun, Observer, Task, check_output_folder};
use crate::error::DataError;
use crate::frames::ScanIndex;
use crate::read::Recording;
use crate::result::{
    CameraRecord, NotLabelled, OutFolder, RunRecord, SequenceNames, UnreadableScan, read_record,
};
use serde::{Deserialize, Serialize};
use std::num::NonZeroUsize;

/// Part of a run that one machine does by itself: scans of a sequence that follow each other in time.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stretch {
    /// Name of the sequence.
    pub sequence: String,
    /// Which of its stretches, from 0.
    pub number: usize,
    /// How many there are.
    pub of: usize,
    /// Of program, settings and the sequence's inputs when it was planned.
    fingerprint: String,
}

/// What is to be done, and what became of earlier results.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Planned {
    /// In any order.
    pub stretches: Vec<Stretch>,
    /// What lay in the output folder already. What is gone is labelled by nobody before all is put together.
    pub earlier: Earlier,
}

/// How a stretch ended.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StretchOutcome {
    /// Scans that can't be labelled.
    pub not_labelled: Vec<NotLabelled>,
    /// What others were labelled without, for it can't be read.
    pub unreadable: Vec<UnreadableScan>,
    /// The images that were asked, in the rig's order.
    pub cameras: Vec<CameraRecord>,
}

impl Stretch {
    /// The scans that belong to it, of all that a sequence has.
    fn scans<'a>(&self, in_time: &'a [ScanIndex]) -> &'a [ScanIndex] {
        // 128 bits hold the product of any two lengths.
        let at = |number: usize| (in_time.len() as u128 * number as u128 / self.of.max(1) as u128) as usize;
        in_time.get(at(self.number)..at(self.number.saturating_add(1))).unwrap_or_default()
    }
}

impl LabelRun<'_> {
    /// Parts of the work, of so many scans at most, for all sequences that are not labelled yet; parts of which all
    /// scans are kept are done. The output folder is made ready as by [`Self::execute`], and the inputs' hashes are
    /// kept there, so that no part has to read all of them.
    ///
    /// # Errors
    /// Those of [`Self::execute`].
    pub fn plan(&self, scans: NonZeroUsize, observer: &dyn Observer) -> Result<Planned, DataError> {
        self.plan_and(|| Ok(()), scans, observer)
    }

    /// The same, with something to keep as soon as nobody else writes to the output folder, and it is no other
    /// recording's.
    pub(crate) fn plan_and(
        &self,
        keep: impl FnOnce() -> Result<(), DataError>,
        scans: NonZeroUsize,
        observer: &dyn Observer,
    ) -> Result<Planned, DataError> {
        check_output_folder(&self.recording.path, self.out)?;
        let labeler = self.labeler()?;
        let tasks = self.tasks(&labeler)?;
        let _lock = self.lock()?;
        let (folder, asked) = self.open_folder(keep, observer)?;
        let mut stretches = Vec::new();
        for (task, identity) in tasks.iter().zip(&asked).filter(|(_, asked)| !folder.holds(&asked.name)) {
            folder.begin(&identity.fingerprint, &Origin::of(task, &identity.inputs))?;
            folder.remember(identity, &task.names.sequence)?;
            let (workspace, in_time) = (folder.workspace(identity, &task.names)?, task.in_time());
            let of = task.scans().div_ceil(scans.get());
            let parts = (0..of).map(|number| Stretch {
                sequence: identity.name.clone(),
                number,
                of,
                fingerprint: identity.fingerprint.clone(),
            });
            let is_done = |part: &Stretch| part.scans(&in_time).iter().all(|scan| workspace.holds(*scan));
            stretches.extend(parts.filter(|part| !is_done(part)));
        }
        Ok(Planned { stretches, earlier: folder.earlier().clone() })
    }

    /// Labels the scans of a stretch that were not labelled before, and leaves them in the output folder. Others may
    /// label stretches of the same run at the same time. Scans that can't be labelled, and what others are labelled
    /// without, are named; [`Self::execute`] names them again.
    ///
    /// # Errors
    /// A sequence that the recording doesn't hold; a stretch that was planned by another version of the program or with
    /// other settings, or for other inputs; results that can't be written; a run that is being put together
    /// ([`DataError::Busy`]).
    pub fn label_stretch(
        &self,
        stretch: &Stretch,
        observer: &dyn Observer,
    ) -> Result<StretchOutcome, DataError> {
        let readers = &self.recording.sequences;
        let reader = readers.iter().find(|reader| reader.sequence().name == stretch.sequence);
        let reader = reader.ok_or_else(|| self.without(&stretch.sequence))?;
        let labeler = self.labeler()?;
        let names = SequenceNames::new(reader.sequence())?;
        let task = self.task(reader.as_ref(), names, &labeler)?;
        self.refuse_links()?;
        let run = self.record();
        let unfinished = Unfinished::of(&OutFolder::new(self.out), &run)?;
        let is_planned = || unfinished.is_planned(&stretch.fingerprint);
        let lock = is_planned()?.then(|| self.lock_shared()).transpose()?;
        // Until the lock was there, somebody may have put all together.
        if lock.is_none() || !is_planned()? {
            return self.check_done(&run, stretch).map(|()| StretchOutcome::default());
        }
        self.label_planned(&task, stretch, &unfinished, observer)
    }

    /// Why there is no sequence of this name: it may have become unreadable since it was planned.
    fn without(&self, name: &str) -> DataError {
        let Recording { path, sequences, incomplete, .. } = self.recording;
        if let Some(lost) = incomplete.iter().find(|lost| lost.name == name) {
            let (place, reason) = (format!("sequence {name}"), lost.lost.to_string());
            return DataError::Unsuitable { file: path.clone(), place, reason };
        }
        let known: Vec<&str> = sequences.iter().map(|reader| reader.sequence().name.as_str()).collect();
        DataError::UnknownSequence { name: name.to_owned(), known: known.join(", ") }
    }

    fn label_planned(
        &self,
        task: &Task,
        stretch: &Stretch,
        unfinished: &Unfinished,
        observer: &dyn Observer,
    ) -> Result<StretchOutcome, DataError> {
        let results = Results::new(self.out);
        let folder = unfinished.scans(&stretch.fingerprint, &task.names.sequence)?;
        let workspace = Workspace::open(&task.names, folder, &results)?;
        let labelling = Labelling { task, config: &self.settings.method, observer };
        let in_time = task.in_time();
        let scans = stretch.scans(&in_time);
        let not_labelled = labelling.label_scans(scans, &workspace, self.jobs)?;
        let missing = not_labelled.iter().map(|scan| (scan.radar.as_str(), scan.scan)).collect();
        let mut without = Without::default();
        scans.iter().filter_map(|scan| workspace.notes(*scan)).for_each(|notes| without.add(notes));
        let (unreadable, _) = without.named(&missing);
        let cameras = without.cameras(&task.rig.cameras);
        Ok(StretchOutcome { not_labelled, unreadable, cameras })
    }

    /// Refuses a stretch that nobody planned, unless its sequence is labelled already.
    fn check_done(&self, run: &RunRecord, stretch: &Stretch) -> Result<(), DataError> {
        let done = read_record(self.out).is_ok_and(|found| {
            let sequence = found.sequence(&stretch.sequence).map(|sequence| &sequence.fingerprint);
            found.is_like(run) && sequence == Some(&stretch.fingerprint)
        });
        if done {
            return Ok(());
        }
        let place = format!("stretch {} of sequence {}", stretch.number, stretch.sequence);
        let expected = "one that was planned here by this program with these settings";
        Err(DataError::content(self.out, place, expected, "another plan, or none: plan again"))
    }
}
