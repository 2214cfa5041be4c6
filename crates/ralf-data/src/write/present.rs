//! Whether a sequence was written before.

use super::measurements::{Contents, Measurement};
use super::metadata::texts;
use super::target::refuse_other_folder;
use crate::disk::files;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::result::{OutFolder, SequenceNames};
use crate::tree::SEQUENCES;
use ralf_jobs::side_by_side;
use std::path::Path;

/// Whether `DATASET/sequences/NAME` is there already, and is this sequence as far as sensors, motion, the times of all
/// measurements, and some of these tell: the first, the middle and the last scan of each radar and LiDAR with their
/// truth, and the first image of each camera with its depth and segmentation, or without. A sequence is put in its
/// place whole, so one that is there is finished.
///
/// # Errors
/// Another sequence of this name, or anything else, lies there; `DATASET` holds labels or is a recording of another
/// format; or one of these measurements can't be read.
pub fn has_sequence(reader: &dyn SequenceReader, dataset: &Path) -> Result<bool, DataError> {
    has(reader, dataset, &Measurement::some(&reader.sequence().times), 1)
}

/// Whether `DATASET/sequences/NAME` is there already, as [`has_sequence`] tells it, and holds every measurement of this
/// sequence with its truth as it would be written; compared by so many threads. This takes as long as writing does.
///
/// # Errors
/// Those of [`has_sequence`].
pub fn has_whole_sequence(
    reader: &dyn SequenceReader,
    dataset: &Path,
    jobs: usize,
) -> Result<bool, DataError> {
    has(reader, dataset, &Measurement::all(&reader.sequence().times), jobs)
}

fn has(
    reader: &dyn SequenceReader,
    dataset: &Path,
    measurements: &[Measurement],
    jobs: usize,
) -> Result<bool, DataError> {
    refuse_other_folder(dataset)?;
    let names = SequenceNames::new(reader.sequence())?;
    let folder = OutFolder::new(dataset).own(SEQUENCES).folder(&names.sequence);
    if !folder.path().exists() {
        return Ok(false);
    }
    for (file, text) in texts(reader.sequence(), &names, &folder)? {
        refuse_another(&folder, &file, text.as_bytes())?;
    }
    let contents = Contents::new(reader, &names, &folder)?;
    side_by_side(measurements, jobs, |measurement| {
        let files = contents.of(*measurement)?;
        files.iter().try_for_each(|(file, bytes)| refuse_another(&folder, file, bytes))?;
        match contents.not_of(*measurement, &files) {
            Some(file) => Err(another(&folder, &file, "is no part of it")),
            None => Ok(()),
        }
    })?;
    Ok(true)
}

fn refuse_another(folder: &OutFolder, file: &Path, bytes: &[u8]) -> Result<(), DataError> {
    if files::read(file).is_ok_and(|found| found == bytes) {
        return Ok(());
    }
    Err(another(folder, file, "differs"))
}

fn another(folder: &OutFolder, file: &Path, how: &str) -> DataError {
    let inside = file.strip_prefix(folder.path()).unwrap_or(file);
    let expected = "none of this name yet, or the sequence that is to be written";
    DataError::content(
        folder.path(),
        "folder",
        expected,
        format!("another one: its {} {how}", inside.display()),
    )
}
