//! Simulated sequences as part of a recording: they have no files, and their truth is known.
//!
//! [`crate::write::write_sequence`] writes the truth as `ground_truth/RADAR/NNNNNN.label`, and beside it
//! `NNNNNN.cause`: one byte per detection, the number of its [`ralf::label::Cause`]. Nothing that labels reads either
//! of them.

use super::dataset::write_sequence;
use crate::disk::label_file::Label;
use crate::error::DataError;
use crate::read::{SequenceReader, TruthLabels};
use ralf::sensors::SourceError;
use ralf_sim::SimulatedSequence;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

/// Writes simulated sequences into a dataset, as many side by side as there are processors; each as
/// [`write_sequence`] does it. `progress` is told how many measurements of all sequences are done.
///
/// # Errors
/// That of the first sequence, in their order, that can't be written; the others are written all the same.
pub fn write_simulated(
    sequences: &[SimulatedSequence],
    dataset: &Path,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<(), DataError> {
    let jobs = thread::available_parallelism().map_or(1, NonZeroUsize::get).min(sequences.len());
    let done: Vec<AtomicUsize> = sequences.iter().map(|_| AtomicUsize::new(0)).collect();
    let next = AtomicUsize::new(0);
    let failed = Mutex::new(Vec::new());
    thread::scope(|scope| {
        for _ in 0..jobs {
            scope.spawn(|| {
                loop {
                    let index = next.fetch_add(1, Ordering::Relaxed);
                    let Some(sequence) = sequences.get(index) else { break };
                    let written = write_sequence(sequence, dataset, &|measurements| {
                        done[index].store(measurements, Ordering::Relaxed);
                        progress(done.iter().map(|count| count.load(Ordering::Relaxed)).sum());
                    });
                    if let Err(error) = written {
                        failed.lock().unwrap_or_else(PoisonError::into_inner).push((index, error));
                    }
                }
            });
        }
    });
    let failed = failed.into_inner().unwrap_or_else(PoisonError::into_inner);
    failed.into_iter().min_by_key(|(index, _)| *index).map_or(Ok(()), |(_, error)| Err(error))
}

impl SequenceReader for SimulatedSequence {
    fn inputs(&self) -> Vec<PathBuf> {
        Vec::new()
    }

    fn warnings(&self) -> &[String] {
        &[]
    }

    fn image_file(&self, _camera: usize, _image: usize) -> Option<PathBuf> {
        None
    }

    fn truth(&self, radar: usize, scan: usize) -> Result<Option<TruthLabels>, SourceError> {
        let truth = SimulatedSequence::truth(self, radar, scan)?;
        Ok(Some(TruthLabels {
            labels: truth.iter().map(|truth| Label::of_class(truth.class)).collect(),
            causes: truth.iter().map(|truth| truth.cause as u8).collect(),
        }))
    }
}
