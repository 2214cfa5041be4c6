//! Several sequences at once: a worker takes the next stretch of whichever sequence it is of, so that none is idle
//! while another labels the end of a sequence or puts it together. Checks of sequences stand in the same queue.
//!
//! Stretches are taken in the order of the sequences, so that no more sequences are under way than there are workers.

use super::checks::check_one;
use super::inputs::Identity;
use super::output_folder::OutputFolder;
use super::unfinished::Finished;
use super::workers::{Labelling, timed};
use super::workspace::Workspace;
use super::{CheckRecord, Checked, LabelRun, Observer, Part, Stage, Task, assemble};
use crate::error::DataError;
use crate::frames::ScanIndex;
use crate::result::{Input, NotLabelled};
use crate::stretches::{Stretch, shared, stretches};
use ralf_train::{Wanted, side_by_side_while};
use std::mem::take;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What one worker does at a time.
enum Item {
    /// Checking the sequence of this number in the recording.
    Check(usize),
    /// Labelling a stretch.
    Label(Stretch),
}

/// What came of it.
enum Done {
    Checked(CheckRecord),
    /// That stretch was the last of a sequence.
    Finished(Finished),
}

/// What all workers share.
struct Queue<'a> {
    run: &'a LabelRun<'a>,
    folder: &'a OutputFolder,
    sequences: Vec<Sequence<'a>>,
    /// Sequences that are not labelled yet.
    left: AtomicUsize,
    observer: &'a dyn Observer,
    told: Option<&'a Checked<'a>>,
}

/// A sequence that is to be labelled.
struct Sequence<'a> {
    task: &'a Task<'a>,
    identity: Identity,
    state: Mutex<State<'a>>,
}

/// How far a sequence is.
struct State<'a> {
    /// Stretches that are not labelled yet.
    left: usize,
    under_way: Option<Arc<UnderWay<'a>>>,
    not_labelled: Vec<NotLabelled>,
    /// What it is read from: for its record.
    inputs: Vec<Input>,
}

/// What a sequence needs from its first stretch to its last.
struct UnderWay<'a> {
    workspace: Workspace<'a>,
    in_time: Vec<ScanIndex>,
}

/// What is left of a sequence that is labelled: nobody else holds the first, these scans could not be labelled, and it
/// was read from these.
type Ended<'a> = (Arc<UnderWay<'a>>, Vec<NotLabelled>, Vec<Input>);

/// Is asked whether to end, and told nothing: others tell meanwhile how they get on.
struct Silent<'a>(&'a dyn Observer);

impl Observer for Silent<'_> {
    fn stopped(&self) -> bool {
        self.0.stopped()
    }
}

impl LabelRun<'_> {
    /// Labels these sequences and puts each together as soon as all of it is labelled; checks all of the recording
    /// meanwhile, where somebody wants to be told. Results are in the order of the sequences.
    pub(super) fn label_sequences(
        &self,
        sequences: Vec<(&Task, Identity)>,
        folder: &OutputFolder,
        observer: &dyn Observer,
        told: Option<&Checked<'_>>,
    ) -> Result<(Vec<Finished>, Vec<CheckRecord>), DataError> {
        let config = &self.settings.method;
        let shared: Vec<_> =
            sequences.iter().map(|(task, _)| shared(task.times(), config, task.times_of_scans())).collect();
        let gathers_evidence = sequences.iter().any(|(task, _)| task.gathers_evidence());
        let stretches = stretches(&shared, gathers_evidence, self.jobs);
        let name = match sequences.as_slice() {
            [(only, _)] => only.reader.sequence().name.clone(),
            several => format!("{} sequences", several.len()),
        };
        let queue = Queue::new(self, sequences, &stretches, (folder, observer, told));
        // A check takes longer than a stretch: begun first, it is over first.
        let checks = (0..self.recording.sequences.len()).filter(|_| told.is_some()).map(Item::Check);
        let items: Vec<Item> = checks.chain(stretches.into_iter().map(Item::Label)).collect();
        if !shared.is_empty() {
            observer.begin(Stage::Labelling(&name), shared.iter().map(|scans| scans.len() as u64).sum());
        }
        let done = side_by_side_while(&items, self.jobs, |item, wanted| queue.work_off(item, wanted));
        observer.end();
        let (mut finished, mut checks) = (Vec::new(), Vec::new());
        for done in done?.into_iter().flatten() {
            match done {
                Done::Checked(check) => checks.push(check),
                Done::Finished(sequence) => finished.push(sequence),
            }
        }
        Ok((finished, checks))
    }
}

impl<'a> Queue<'a> {
    fn new(
        run: &'a LabelRun<'a>,
        sequences: Vec<(&'a Task<'a>, Identity)>,
        stretches: &[Stretch],
        (folder, observer, told): (&'a OutputFolder, &'a dyn Observer, Option<&'a Checked<'a>>),
    ) -> Self {
        let sequence = |(number, (task, mut identity)): (usize, (&'a Task<'a>, Identity))| {
            let left = stretches.iter().filter(|stretch| stretch.sequence == number).count();
            let inputs = take(&mut identity.inputs);
            let state = State { left, under_way: None, not_labelled: Vec::new(), inputs };
            Sequence { task, identity, state: Mutex::new(state) }
        };
        let sequences: Vec<_> = sequences.into_iter().enumerate().map(sequence).collect();
        let left = AtomicUsize::new(sequences.len());
        Self { run, folder, sequences, left, observer, told }
    }

    fn work_off(&self, item: &Item, wanted: &Wanted) -> Result<Option<Done>, DataError> {
        match item {
            Item::Check(sequence) => self.check(*sequence).map(Done::Checked).map(Some),
            Item::Label(stretch) => {
                let finished = self.label(&self.sequences[stretch.sequence], stretch, wanted)?;
                Ok(finished.map(Done::Finished))
            }
        }
    }

    fn check(&self, sequence: usize) -> Result<CheckRecord, DataError> {
        if self.observer.stopped() {
            return Err(DataError::Stopped);
        }
        let reader = self.run.recording.sequences[sequence].as_ref();
        let check = timed(self.observer, Part::Checking, || check_one(reader));
        if let Some(told) = self.told {
            told(&check);
        }
        Ok(check)
    }

    /// Labels a stretch. With the last one of a sequence the sequence is put together.
    fn label(
        &self,
        sequence: &Sequence<'a>,
        stretch: &Stretch,
        wanted: &Wanted,
    ) -> Result<Option<Finished>, DataError> {
        let task = sequence.task;
        let under_way = sequence.open(self.folder)?;
        let labelling = Labelling { task, config: &self.run.settings.method, observer: self.observer };
        let scans = &under_way.in_time[stretch.scans.clone()];
        let failed = labelling.label_stretch(scans, &under_way.workspace, wanted)?;
        // Another worker has failed at an earlier stretch: some of these scans may not be labelled.
        if !wanted.still() {
            return Ok(None);
        }
        drop(under_way);
        let Some(ended) = sequence.end(failed) else { return Ok(None) };
        let is_last = self.left.fetch_sub(1, Ordering::Relaxed) == 1;
        timed(self.observer, Part::Writing, || self.finish(sequence, ended, is_last)).map(Some)
    }

    /// Puts a sequence together that is labelled.
    fn finish(
        &self,
        Sequence { task, identity, .. }: &Sequence,
        (under_way, not_labelled, inputs): Ended,
        is_last: bool,
    ) -> Result<Finished, DataError> {
        let silent = Silent(self.observer);
        let told = if is_last { self.observer } else { &silent };
        told.end();
        // The other workers are done with all but their own sequences.
        let jobs = if is_last { self.run.jobs } else { 1 };
        let workspace = &under_way.workspace;
        let record = assemble::assemble(task, &identity.fingerprint, workspace, not_labelled, jobs, told)?;
        // Its files are closed before they are removed: some file systems keep the folder of a removed open file.
        drop(under_way);
        let finished = (record, inputs);
        self.folder.finish_sequence(&finished)?;
        Ok(finished)
    }
}

impl<'a> Sequence<'a> {
    /// What its stretches share; it lives until the last of them is labelled.
    fn open(&self, folder: &'a OutputFolder) -> Result<Arc<UnderWay<'a>>, DataError> {
        let mut state = self.state();
        if let Some(under_way) = &state.under_way {
            return Ok(under_way.clone());
        }
        let workspace = folder.workspace(&self.identity, &self.task.names)?;
        let under_way = Arc::new(UnderWay { workspace, in_time: self.task.in_time() });
        state.under_way = Some(under_way.clone());
        Ok(under_way)
    }

    /// A stretch is labelled but for these scans. With the last one: all that could not be labelled, and what its
    /// stretches shared.
    fn end(&self, not_labelled: Vec<NotLabelled>) -> Option<Ended<'a>> {
        let mut state = self.state();
        state.left -= 1;
        state.not_labelled.extend(not_labelled);
        if state.left > 0 {
            return None;
        }
        state.not_labelled.sort();
        let (not_labelled, inputs) = (take(&mut state.not_labelled), take(&mut state.inputs));
        Some((state.under_way.take()?, not_labelled, inputs))
    }

    fn state(&self) -> MutexGuard<'_, State<'a>> {
        // No worker leaves it in disorder, not even one that panics.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
