//! Whether the run that writes to a folder has ended: what it keeps until then lies there.

use crate::disk::files;
use crate::error::DataError;
use crate::tree::UNFINISHED;
use std::path::Path;

/// In place of results that are whole, in words.
pub(crate) const FOUND: &str = "an unfinished run: the same command goes on where it stopped";

/// Whether a run that has not ended keeps anything in this folder.
pub fn is_under_way(out: &Path) -> Result<bool, DataError> {
    let all = out.join(UNFINISHED);
    for run in files::folders(&all)? {
        if !files::names(&all.join(run))?.is_empty() {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Whether such a run has labelled some scans of this sequence, and maybe not all.
pub(crate) fn is_begun(out: &Path, sequence: &str) -> Result<bool, DataError> {
    let all = out.join(UNFINISHED);
    for run in files::folders(&all)? {
        let run = all.join(run);
        for fingerprint in files::folders(&run)? {
            if files::folders(&run.join(fingerprint))?.iter().any(|name| name == sequence) {
                return Ok(true);
            }
        }
    }
    Ok(false)
}
