//! What is written beside a recording's measurements would be taken for a part of it.

use crate::disk::files;
use crate::disk::real_path::real_path;
use crate::error::DataError;
use crate::tree::{SEQUENCES, sensors_file};
use std::path::Path;

/// Refuses to write to a place that is the recording's own, or among the sequences of any other in the own layout:
/// inputs are only read.
pub fn refuse_to_write_into(recording: &Path, out: &Path) -> Result<(), DataError> {
    let (place, recording) = (real_path(out), real_path(recording));
    if place == recording || place.starts_with(recording.join(SEQUENCES)) {
        return Err(DataError::content(out, "output", "a place outside the recording", "a part of it"));
    }
    refuse_among_sequences(out)
}

/// Refuses a place among the sequences of a recording in the own layout.
pub(crate) fn refuse_among_sequences(out: &Path) -> Result<(), DataError> {
    let place = real_path(out);
    let folders = place.ancestors().filter(|folder| folder.file_name().is_some_and(|name| name == SEQUENCES));
    for recording in folders.filter_map(Path::parent) {
        // What can't be listed on the way is no business of who writes below it.
        let names = files::folders(&recording.join(SEQUENCES)).unwrap_or_default();
        if let Some(name) = names.iter().find(|name| sensors_file(recording, name).is_file()) {
            let found = format!(
                "a part of {}, which has {}",
                recording.display(),
                sensors_file(recording, name).display()
            );
            return Err(DataError::content(out, "output", "a place outside recordings", found));
        }
    }
    Ok(())
}
