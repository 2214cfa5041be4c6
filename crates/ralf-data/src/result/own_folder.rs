//! Folders in the making, hidden beside their places: only those that carry a mark of ours are ever removed.

use super::names::OutFolder;
use crate::disk::files;
use crate::error::DataError;
use std::fs;
use std::io;
use std::path::Path;

/// Begins a folder with an empty file of the name `mark`: what a killed program left of it goes.
///
/// # Errors
/// Those of [`remove_own`], and the system's.
pub(crate) fn begin(folder: &OutFolder, mark: &'static str) -> Result<(), DataError> {
    remove_own(folder.path(), mark)?;
    let file = folder.own_file(mark);
    fs::create_dir_all(folder.path()).map_err(DataError::io(folder.path()))?;
    // Not beside its place, as all other files are written: what a kill leaves is to be known by it.
    let marked = fs::write(&file, "").inspect_err(|_| drop(fs::remove_dir(folder.path())));
    marked.map_err(DataError::io(&file))
}

/// The name that a mark has in a folder that is being removed: what a kill leaves of it is known as ours, and as no
/// whole one.
const REMOVED: &str = ".ralf-removed";

/// Removes a folder, if it is there, with all that is in it, and that has to be a file of the name `mark`, by which it
/// is known as ours; or nothing.
///
/// # Errors
/// [`refuse_others`] refuses it, or the system does.
pub(crate) fn remove_own(folder: &Path, mark: &str) -> Result<(), DataError> {
    refuse_others(folder, mark)?;
    remove(folder, mark)
}

/// Removes a folder that is known as ours, if it is there; the mark is gone last.
///
/// # Errors
/// The system's.
pub(crate) fn remove(folder: &Path, mark: &str) -> Result<(), DataError> {
    let removed = || {
        unless_gone(fs::rename(folder.join(mark), folder.join(REMOVED)))?;
        for entry in fs::read_dir(folder)? {
            let entry = entry?;
            if entry.file_name() == REMOVED {
                continue;
            }
            let is_folder = entry.file_type()?.is_dir();
            let path = entry.path();
            unless_gone(if is_folder { fs::remove_dir_all(path) } else { fs::remove_file(path) })?;
        }
        fs::remove_dir_all(folder)
    };
    unless_gone(removed()).map_err(DataError::io(folder))
}

fn unless_gone(result: io::Result<()>) -> io::Result<()> {
    if result.as_ref().is_err_and(|error| error.kind() == io::ErrorKind::NotFound) { Ok(()) } else { result }
}

/// Refuses all but a folder with a file of the name `mark`, one that was being removed, an empty one, and nothing: it
/// may be somebody else's.
pub(crate) fn refuse_others(folder: &Path, mark: &str) -> Result<(), DataError> {
    let is_ours = match fs::symlink_metadata(folder) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(()),
        Ok(found) if found.is_dir() => {
            files::exists(&folder.join(mark))?
                || files::exists(&folder.join(REMOVED))?
                || fs::read_dir(folder).map_err(DataError::io(folder))?.next().is_none()
        }
        found => found.map_err(DataError::io(folder)).map(|_| false)?,
    };
    if is_ours {
        return Ok(());
    }
    let expected = "nothing of this name, or what ralf has left here";
    let found = format!("something else, without a file {mark}, which would be lost: move it away");
    Err(DataError::content(folder, "folder", expected, found))
}
