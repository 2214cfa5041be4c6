//! Simulated sequences as part of a recording: they have no files, and their truth is known.
//!
//! [`crate::write::write_sequence`] writes the truth as `ground_truth/RADAR/NNNNNN.label`, and beside it
//! `NNNNNN.cause`: one byte per detection, the number of its [`ralf::label::Cause`]. Nothing that labels reads either
//! of them.

use super::dataset::write_sequence_with;
use crate::disk::label_file::Label;
use crate::error::DataError;
use crate::read::{SequenceReader, TruthLabels};
use ralf::label::Cause;
use ralf::sensors::{Source, SourceError};
use ralf_sim::SimulatedSequence;
use std::path::Path;

/// Writes simulated sequences into a dataset, one after the other, each with so many threads as
/// [`write_sequence_with`] does it. `progress` is told how many measurements of all sequences are done.
///
/// # Errors
/// That of the first sequence, in their order, that can't be written; the others are written all the same.
pub fn write_simulated(
    sequences: &[SimulatedSequence],
    dataset: &Path,
    jobs: usize,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<(), DataError> {
    let (mut before, mut failed) = (0, None);
    for sequence in sequences {
        let written = write_sequence_with(sequence, dataset, jobs, &|done| progress(before + done));
        failed = failed.or(written.err());
        before += sequence.sequence().times.measurements();
    }
    failed.map_or(Ok(()), Err)
}

impl SequenceReader for SimulatedSequence {
    fn truth(&self, radar: usize, scan: usize) -> Result<Option<TruthLabels>, SourceError> {
        let truth = SimulatedSequence::truth(self, radar, scan)?;
        Ok(Some(TruthLabels {
            labels: truth.iter().map(|truth| Label::of_class(truth.class)).collect(),
            causes: truth.iter().map(|truth| truth.cause as u8).collect(),
        }))
    }

    fn has_segmentation(&self) -> bool {
        self.is_segmented()
    }

    fn causes(&self) -> &'static [Cause] {
        SimulatedSequence::causes(self)
    }
}
