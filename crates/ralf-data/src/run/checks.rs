//! What a check says of a recording's sequences, several at a time.

use crate::read::{Recording, SequenceReader};
use crate::result::CheckRecord;
use ralf_jobs::side_by_side;
use std::path::Path;

/// What [`ralf_check::check`] says of each sequence, in the recording's order, by so many threads.
pub fn check_all(recording: &Recording, jobs: usize) -> Vec<CheckRecord> {
    let Ok(checks) = side_by_side(&recording.sequences, jobs, |reader| {
        Ok::<_, std::convert::Infallible>(check_one(reader.as_ref(), &recording.path))
    });
    checks
}

/// What it says of one sequence of the recording at `root`.
pub(super) fn check_one(reader: &dyn SequenceReader, root: &Path) -> CheckRecord {
    CheckRecord::of(&ralf_check::check(reader), root)
}
