//! What there is to know of a recording before its labels are believed.

use super::LabelRun;
use crate::read::inspection::held_motion;

/// The sentence about sequences that were labelled, and are not there any more ([`Outcome::gone`]).
///
/// [`Outcome::gone`]: super::Outcome::gone
pub fn told_gone(names: &[String]) -> String {
    let names = names.join(", ");
    format!(
        "expected all sequences that were labelled from here, found none of {names}: their labels stay as they are"
    )
}

impl LabelRun<'_> {
    /// Which sequences are left out and why, what readers warn of, and which measurements lie outside of all that is
    /// known of the motion: a sentence each, with the name of its sequence.
    pub fn warnings(&self) -> Vec<String> {
        let left_out = self.recording.left_out().into_iter().map(|sequence| format!("left out: {sequence}"));
        let of_sequence = self.recording.sequences.iter().flat_map(|reader| {
            let sequence = reader.sequence();
            let sentences = reader.warnings().iter().cloned().chain(held_motion(sequence));
            sentences.map(|sentence| format!("{}: {sentence}", sequence.name))
        });
        left_out.chain(self.recording.told_not_copied()).chain(of_sequence).collect()
    }
}
