//! What there is to know of a recording before its labels are believed.

use super::LabelRun;
use crate::read::inspection::held_motion;

impl LabelRun<'_> {
    /// What readers warn of, and which measurements lie outside of all that is known of the motion: a sentence each,
    /// after the name of its sequence.
    pub fn warnings(&self) -> Vec<String> {
        let of_sequence = self.recording.sequences.iter().flat_map(|reader| {
            let sequence = reader.sequence();
            let sentences = reader.warnings().iter().cloned().chain(held_motion(sequence));
            sentences.map(|sentence| format!("{}: {sentence}", sequence.name))
        });
        of_sequence.collect()
    }
}
