//! Whether a folder can take the results of a run: asked before anything is done for them.

use crate::disk::files;
use crate::error::DataError;
use crate::read::refuse_to_write_into;
use crate::result::OutFolder;
use crate::tree::{RECORD, SEQUENCES};
use std::path::Path;

/// Refuses a part of the recording, a file in the place of the folder or of the sequences' own, and what is no file in
/// that of the record.
pub fn check_output_folder(recording: &Path, out: &Path) -> Result<(), DataError> {
    refuse_to_write_into(recording, out)?;
    let place = OutFolder::new(out);
    for folder in [out, place.own(SEQUENCES).path()] {
        if files::exists(folder)? && !folder.is_dir() {
            return Err(DataError::content(folder, "output", "a folder, or nothing yet", "a file"));
        }
    }
    let record = place.own_file(RECORD);
    if files::exists(&record)? && !record.is_file() {
        return Err(DataError::content(&record, "output", "a file, or nothing yet", "a folder"));
    }
    Ok(())
}
