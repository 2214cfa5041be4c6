//! Several sequences at once: a worker takes the next stretch of whichever sequence it is of, so that none is idle
//! while another labels the end of a sequence or puts it together. Checks of sequences come before all stretches.
//!
//! Stretches are taken in the order of the sequences, so that hardly more are under way than there are workers.

use super::checks::check_one;
use super::inputs::Identity;
use super::kept::{Finished, Origin};
use super::output_folder::OutputFolder;
use super::workers::{Labelling, timed};
use super::workspace::Workspace;
use super::{CheckRecord, Checked, LabelRun, Observer, Part, Stage, Task, assemble};
use crate::error::DataError;
use crate::frames::{OwnWindow, ScanIndex};
use crate::result::{Input, NotLabelled};
use crate::stretches::{Stretches, needs};
use ralf_jobs::work_off;
use std::mem::take;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What is done besides labelling scans.
enum Alone {
    /// Checking the sequence of this number in the recording.
    Check(usize),
    /// Putting the sequence of this number, of those that are to be labelled, together, which has no scans.
    Finish(usize),
}

/// What came of one place of the work.
enum Done {
    Checked(CheckRecord),
    /// That scan was the last of the sequence of this number.
    Finished(usize, Box<Finished>),
}

/// What all workers share.
struct Queue<'a> {
    run: &'a LabelRun<'a>,
    folder: &'a OutputFolder,
    alone: Vec<Alone>,
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
    /// Scans that are not labelled yet.
    left: usize,
    under_way: Option<Arc<UnderWay<'a>>>,
    not_labelled: Vec<NotLabelled>,
    /// What it is read from: for its record.
    inputs: Vec<Input>,
}

/// What a sequence needs from its first scan to its last.
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
        let needs: Vec<_> =
            sequences.iter().map(|(task, _)| needs(task.times(), config, task.times_of_scans())).collect();
        let gathers_evidence = sequences.iter().any(|(task, _)| task.gathers_evidence());
        let name = match sequences.as_slice() {
            [(only, _)] => only.reader.sequence().name.clone(),
            several => format!("{} sequences", several.len()),
        };
        let queue = Queue::new(self, sequences, folder, observer, told);
        let stretches = Stretches::new(queue.alone.len(), &needs, gathers_evidence, self.jobs);
        if !needs.is_empty() {
            observer.begin(Stage::Labelling(&name), needs.iter().map(|scans| scans.len() as u64).sum());
        }
        let done = work_off(
            self.jobs,
            OwnWindow::default,
            |worker| stretches.next(worker),
            |own, place| match stretches.scan(place) {
                Some((sequence, scan)) => queue.label(sequence, scan, own),
                None => queue.do_alone(&queue.alone[place]),
            },
        );
        observer.end();
        let (mut finished, mut checks) = (Vec::new(), Vec::new());
        for done in done? {
            match done {
                Done::Checked(check) => checks.push(check),
                Done::Finished(number, sequence) => finished.push((number, *sequence)),
            }
        }
        finished.sort_by_key(|(number, _)| *number);
        Ok((finished.into_iter().map(|(_, sequence)| sequence).collect(), checks))
    }
}

impl<'a> Queue<'a> {
    fn new(
        run: &'a LabelRun<'a>,
        sequences: Vec<(&'a Task<'a>, Identity)>,
        folder: &'a OutputFolder,
        observer: &'a dyn Observer,
        told: Option<&'a Checked<'a>>,
    ) -> Self {
        // A check takes longer than a scan: begun first, it is over first.
        let checks = (0..run.recording.sequences.len()).filter(|_| told.is_some()).map(Alone::Check);
        let empty = sequences.iter().enumerate().filter(|(_, (task, _))| task.scans() == 0);
        let alone = checks.chain(empty.map(|(number, _)| Alone::Finish(number))).collect();
        let sequence = |(task, mut identity): (&'a Task<'a>, Identity)| {
            let inputs = take(&mut identity.inputs);
            let state = State { left: task.scans(), under_way: None, not_labelled: Vec::new(), inputs };
            Sequence { task, identity, state: Mutex::new(state) }
        };
        let sequences: Vec<_> = sequences.into_iter().map(sequence).collect();
        let left = AtomicUsize::new(sequences.len());
        Self { run, folder, alone, sequences, left, observer, told }
    }

    fn do_alone(&self, work: &Alone) -> Result<Option<Done>, DataError> {
        match work {
            Alone::Check(sequence) => self.check(*sequence).map(Done::Checked).map(Some),
            Alone::Finish(sequence) => {
                self.sequences[*sequence].open(self.folder)?;
                let ended = self.sequences[*sequence].end(None);
                ended.map(|ended| self.put_together(*sequence, ended)).transpose()
            }
        }
    }

    fn check(&self, sequence: usize) -> Result<CheckRecord, DataError> {
        if self.observer.stopped() {
            return Err(DataError::Stopped);
        }
        let recording = self.run.recording;
        let reader = recording.sequences[sequence].as_ref();
        let check = timed(self.observer, Part::Checking, || check_one(reader, &recording.path));
        if let Some(told) = self.told {
            told(&check);
        }
        Ok(check)
    }

    /// Labels a scan, by its number in the order of time. With the last one of a sequence the sequence is put together.
    fn label(&self, number: usize, scan: usize, own: &mut OwnWindow<'a>) -> Result<Option<Done>, DataError> {
        let sequence = &self.sequences[number];
        let under_way = sequence.open(self.folder)?;
        let labelling =
            Labelling { task: sequence.task, config: &self.run.settings.method, observer: self.observer };
        let window = own.over(number, &labelling.frames());
        let failed = labelling
            .while_wanted(|| labelling.label_next(&under_way.workspace, window, under_way.in_time[scan]))?;
        drop(under_way);
        let Some(ended) = sequence.end(failed) else { return Ok(None) };
        // Nobody needs it any more, and what follows takes memory, too.
        *own = OwnWindow::default();
        self.put_together(number, ended).map(Some)
    }

    /// Puts the sequence of this number together, all of which is labelled.
    fn put_together(&self, number: usize, ended: Ended) -> Result<Done, DataError> {
        let is_last = self.left.fetch_sub(1, Ordering::Relaxed) == 1;
        let finish = || self.finish(&self.sequences[number], ended, is_last);
        let sequence = timed(self.observer, Part::Writing, finish)?;
        Ok(Done::Finished(number, Box::new(sequence)))
    }

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
    /// What its scans share; it lives until the last of them is labelled.
    fn open(&self, folder: &'a OutputFolder) -> Result<Arc<UnderWay<'a>>, DataError> {
        let mut state = self.state();
        if let Some(under_way) = &state.under_way {
            return Ok(under_way.clone());
        }
        folder.begin(&self.identity.fingerprint, &Origin::of(self.task, &state.inputs))?;
        let workspace = folder.workspace(&self.identity, &self.task.names)?;
        let under_way = Arc::new(UnderWay { workspace, in_time: self.task.in_time() });
        state.under_way = Some(under_way.clone());
        Ok(under_way)
    }

    /// Another scan is labelled, or can't be. With the last one: all that could not be labelled, and what its scans
    /// shared.
    fn end(&self, failed: Option<NotLabelled>) -> Option<Ended<'a>> {
        let mut state = self.state();
        state.left = state.left.saturating_sub(1);
        state.not_labelled.extend(failed);
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
