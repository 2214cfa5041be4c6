//! Several sequences at once: a worker takes the next stretch of whichever sequence it is of, so that none is idle
//! while another labels the end of a sequence or puts it together.
//!
//! Stretches are taken in the order of the sequences, so that no more sequences are under way than there are workers.

use super::inputs::Identity;
use super::output_folder::OutputFolder;
use super::unfinished::Finished;
use super::workers::Labelling;
use super::workspace::Workspace;
use super::{LabelRun, Observer, Part, Stage, Task, assemble};
use crate::error::DataError;
use crate::frames::{ScanIndex, Stretch, side_by_side, stretches};
use crate::result::NotLabelled;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// What all workers share.
struct Queue<'a> {
    run: &'a LabelRun<'a>,
    folder: &'a OutputFolder,
    sequences: Vec<Sequence<'a>>,
    /// Stretches that are not labelled yet.
    left: AtomicUsize,
    /// Somebody has failed.
    stop: AtomicBool,
    observer: &'a dyn Observer,
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

/// Is asked whether to end, and told nothing: others tell meanwhile how they get on.
struct Silent<'a>(&'a dyn Observer);

impl Observer for Silent<'_> {
    fn stopped(&self) -> bool {
        self.0.stopped()
    }
}

impl LabelRun<'_> {
    /// Labels these sequences and puts each together as soon as all of it is labelled. Results are in their order.
    pub(super) fn label_sequences(
        &self,
        sequences: &[(&Task, &Identity)],
        folder: &OutputFolder,
        observer: &dyn Observer,
    ) -> Result<Vec<Finished>, DataError> {
        let Some((first, _)) = sequences.first() else { return Ok(Vec::new()) };
        let counts: Vec<usize> = sequences.iter().map(|(task, _)| task.scans()).collect();
        let stretches = stretches(&counts, first.gathers_evidence(), self.jobs);
        let sequence = |(number, &(task, identity)): (usize, &(_, _))| {
            let left = stretches.iter().filter(|stretch| stretch.sequence == number).count();
            let state = State { left, under_way: None, not_labelled: Vec::new() };
            Sequence { task, identity, state: Mutex::new(state) }
        };
        let queue = Queue {
            run: self,
            folder,
            sequences: sequences.iter().enumerate().map(sequence).collect(),
            left: AtomicUsize::new(stretches.len()),
            stop: AtomicBool::new(false),
            observer,
        };
        let name = match sequences {
            [(only, _)] => only.reader.sequence().name.clone(),
            several => format!("{} sequences", several.len()),
        };
        observer.begin(Stage::Labelling(&name), counts.iter().sum::<usize>() as u64);
        let finished = side_by_side(&stretches, self.jobs, |stretch| queue.work_off(stretch));
        observer.end();
        Ok(finished?.into_iter().flatten().collect())
    }
}

impl<'a> Queue<'a> {
    /// Labels a stretch. With the last one of a sequence the sequence is put together.
    fn work_off(&self, stretch: &Stretch) -> Result<Option<Finished>, DataError> {
        let done = self.label(&self.sequences[stretch.sequence], stretch);
        done.inspect_err(|_| self.stop.store(true, Ordering::Relaxed))
    }

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
        let is_last = self.left.fetch_sub(1, Ordering::Relaxed) == 1;
        let Some(not_labelled) = sequence.end(failed) else { return Ok(None) };
        labelling.timed(Part::Writing, || self.finish(sequence, &under_way, not_labelled, is_last)).map(Some)
    }

    /// Puts a sequence together that is labelled.
    fn finish(
        &self,
        Sequence { task, identity, .. }: &Sequence,
        under_way: &UnderWay,
        not_labelled: Vec<NotLabelled>,
        is_last: bool,
    ) -> Result<Finished, DataError> {
        let silent = Silent(self.observer);
        let told = if is_last { self.observer } else { &silent };
        told.end();
        let record =
            assemble::assemble(task, &identity.fingerprint, &under_way.workspace, not_labelled, told)?;
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

    /// A stretch is labelled but for these scans. With the last one: all that could not be labelled.
    fn end(&self, not_labelled: Vec<NotLabelled>) -> Option<Vec<NotLabelled>> {
        let mut state = self.state();
        state.left -= 1;
        state.not_labelled.extend(not_labelled);
        if state.left > 0 {
            return None;
        }
        state.under_way = None;
        state.not_labelled.sort();
        Some(std::mem::take(&mut state.not_labelled))
    }

    fn state(&self) -> MutexGuard<'_, State<'a>> {
        // No worker leaves it in disorder, not even one that panics.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}
