//! What is written beside a recording's measurements would be taken for a part of it.

use crate::disk::real_path::real_path;
use crate::error::DataError;
use crate::tree::SEQUENCES;
use std::path::Path;

/// Refuses to write to a place that is the recording's own: inputs are only read.
pub fn refuse_to_write_into(recording: &Path, out: &Path) -> Result<(), DataError> {
    let (place, recording) = (real_path(out), real_path(recording));
    if place != recording && !place.starts_with(recording.join(SEQUENCES)) {
        return Ok(());
    }
    Err(DataError::content(out, "output", "a place outside the recording", "a part of it"))
}
