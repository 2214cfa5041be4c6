//! Whether a folder can take sequences: among labels, or in another format's recording, they would hide what was there.

use crate::disk::files;
use crate::error::DataError;
use crate::read::open::refuse_other_format;
use crate::read::outside::refuse_own_places;
use crate::tree::MARKS_OF_LABELS;
use std::path::Path;

/// Refuses a part of a recording, a folder of labels, and what is a recording of another format than the own layout:
/// with `sequences` in it, it would be taken for one in the own layout.
pub(super) fn refuse_other_folder(dataset: &Path) -> Result<(), DataError> {
    let expected = "a recording in the own layout, or nothing yet";
    refuse_own_places(dataset)?;
    // Labels look like a recording in the own layout, so these are asked for first.
    for mark in MARKS_OF_LABELS {
        if files::exists(&dataset.join(mark))? {
            let found = format!("labels, with {mark}");
            return Err(DataError::content(dataset, "output", expected, found));
        }
    }
    refuse_other_format(dataset, expected)
}
