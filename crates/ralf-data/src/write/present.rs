//! Whether a sequence was written before.

use super::measurements::{Content, Contents, Measurement};
use super::metadata::texts;
use super::target::refuse_other_folder;
use crate::disk::files;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::result::{OutFolder, SequenceNames};
use crate::tree::{ODOMETRY, POSES, SEQUENCES};
use ralf_jobs::side_by_side;
use std::path::{Path, PathBuf};

/// Whether `DATASET/sequences/NAME` is there already, and is this sequence as far as sensors, motion, the times of all
/// measurements, and some of these tell: the first, the middle and the last scan of each radar and LiDAR with their
/// truth, and the first image of each camera. Motion, times of points, depth and segmentations are there or not there
/// as they would be written. A sequence is put in its place whole, so one that is there is finished.
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
    let contents = Contents::new(reader, &names, &folder)?;
    let texts = texts(reader.sequence(), &names, &folder)?.into_iter();
    let own: Vec<_> = texts.map(|(file, text)| (file, text.into_bytes())).collect();
    refuse_another(&folder, &own, [ODOMETRY, POSES].map(|name| folder.own_file(name)))?;
    refuse_another(&folder, contents.names_of_causes()?.as_slice(), [])?;
    side_by_side(measurements, jobs, |measurement| {
        refuse_another(&folder, &contents.of(*measurement)?, contents.beside(*measurement))
    })?;
    Ok(true)
}

/// Refuses other files than these, and such as not every sequence has and this one hasn't.
fn refuse_another(
    folder: &OutFolder,
    own: &[Content],
    possible: impl IntoIterator<Item = PathBuf>,
) -> Result<(), DataError> {
    let is_same = |file: &Path, bytes: &[u8]| files::read(file).is_ok_and(|found| found == bytes);
    if let Some((file, _)) = own.iter().find(|(file, bytes)| !is_same(file, bytes)) {
        return Err(another(folder, file, "differs"));
    }
    let is_own = |file: &PathBuf| own.iter().any(|(known, _)| known == file);
    match possible.into_iter().find(|file| file.exists() && !is_own(file)) {
        Some(file) => Err(another(folder, &file, "is no part of it")),
        None => Ok(()),
    }
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
