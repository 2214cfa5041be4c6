//! Simulated sequences as part of a recording: they have no files, and their truth is known.
//!
//! [`crate::write::write_sequence`] writes the truth as `ground_truth/RADAR/NNNNNN.label`, and beside it
//! `NNNNNN.cause`: one byte per detection, the number of its [`ralf::label::Cause`]. Nothing that labels reads either
//! of them.

use crate::disk::label_file::Label;
use crate::read::{SequenceReader, TruthLabels};
use ralf::label::Cause;
use ralf::sensors::SourceError;
use ralf_sim::SimulatedSequence;

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
