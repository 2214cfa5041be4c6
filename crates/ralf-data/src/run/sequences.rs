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
use crate::frames::{ScanIndex, Stretch, side_by_side, stretches};
use crate::result::NotLabelled;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
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
    /// Somebody has failed.
    stop: AtomicBool,
    observer: &'a dyn Observer,
    told: Option<&'a Checked<'a>>,
}

/// A sequence that is to be labelled.
struct Sequence<'a> {
    task: &'a Task<'a>,
    identity: &'a Identity,
    state: Mutex<State<'a>>,
}

/// How far a sequence is.
struct State<'a> {
    /// Stretches that are not labelled yet.
    left: usize,
    under_way: Option<Arc<UnderWay<'a>>>,
    not_labelled: Vec<NotLabelled>,
}

/// What a sequence needs from its first stretch to its last.
struct UnderWay<'a> {
    workspace: Workspace<'a>,
    in_time: Vec<ScanIndex>,
}

/// What is left of a sequence that is labelled: nobody else holds the first, and these scans could not be labelled.
type Ended<'a> = (Arc<UnderWay<'a>>, Vec<NotLabelled>);

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
        sequences: &[(&Task, &Identity)],
        folder: &OutputFolder,
        observer: &dyn Observer,
        told: Option<&Checked<'_>>,
    ) -> Result<(Vec<Finished>, Vec<CheckRecord>), DataError> {
        let counts: Vec<usize> = sequences.iter().map(|(task, _)| task.scans()).collect();
        let gathers_evidence = sequences.iter().any(|(task, _)| task.gathers_evidence());
        let stretches = stretches(&counts, gathers_evidence, self.jobs);
        let queue = Queue::new(self, sequences, &stretches, (folder, observer, told));
        let name = match sequences {
            [(only, _)] => only.reader.sequence().name.clone(),
            several => format!("{} sequences", several.len()),
        };
        // A check takes longer than a stretch: begun first, it is over first.
        let checks = (0..self.recording.sequences.len()).filter(|_| told.is_some()).map(Item::Check);
        let items: Vec<Item> = checks.chain(stretches.into_iter().map(Item::Label)).collect();
        if !sequences.is_empty() {
            observer.begin(Stage::Labelling(&name), counts.iter().sum::<usize>() as u64);
        }
        let done = side_by_side(&items, self.jobs, |item| queue.work_off(item));
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
        sequences: &[(&'a Task<'a>, &'a Identity)],
        stretches: &[Stretch],
        (folder, observer, told): (&'a OutputFolder, &'a dyn Observer, Option<&'a Checked<'a>>),
    ) -> Self {
        let sequence = |(number, &(task, identity)): (usize, &(&'a Task<'a>, &'a Identity))| {
            let left = stretches.iter().filter(|stretch| stretch.sequence == number).count();
            let state = State { left, under_way: None, not_labelled: Vec::new() };
            Sequence { task, identity, state: Mutex::new(state) }
        };
        let sequences: Vec<_> = sequences.iter().enumerate().map(sequence).collect();
        let (left, stop) = (AtomicUsize::new(sequences.len()), AtomicBool::new(false));
        Self { run, folder, sequences, left, stop, observer, told }
    }

    fn work_off(&self, item: &Item) -> Result<Option<Done>, DataError> {
        let done = match item {
            Item::Check(sequence) => self.check(*sequence).map(Done::Checked).map(Some),
            Item::Label(stretch) => {
                let finished = self.label(&self.sequences[stretch.sequence], stretch);
                finished.map(|finished| finished.map(Done::Finished))
            }
        };
        done.inspect_err(|_| self.stop.store(true, Ordering::Relaxed))
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
    fn label(&self, sequence: &Sequence<'a>, stretch: &Stretch) -> Result<Option<Finished>, DataError> {
        let task = sequence.task;
        let under_way = sequence.open(self.folder)?;
        let labelling = Labelling { task, config: &self.run.settings.method, observer: self.observer };
        let scans = &under_way.in_time[stretch.scans.clone()];
        let failed = labelling.label_stretch(scans, &under_way.workspace, &self.stop)?;
        // Another worker has failed meanwhile: some of these scans may not be labelled.
        if self.stop.load(Ordering::Relaxed) {
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
        (under_way, not_labelled): Ended,
        is_last: bool,
    ) -> Result<Finished, DataError> {
        let silent = Silent(self.observer);
        let told = if is_last { self.observer } else { &silent };
        told.end();
        let record =
            assemble::assemble(task, &identity.fingerprint, &under_way.workspace, not_labelled, told)?;
        // Its files are closed before they are removed: some file systems keep the folder of a removed open file.
        drop(under_way);
        let finished = (record, identity.inputs.clone());
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
        let workspace = folder.workspace(self.identity, &self.task.names)?;
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
        Some((state.under_way.take()?, std::mem::take(&mut state.not_labelled)))
    }

    fn state(&self) -> MutexGuard<'_, State<'a>> {
        // No worker leaves it in disorder, not even one that panics.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
