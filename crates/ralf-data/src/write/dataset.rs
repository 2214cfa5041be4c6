//! Writing any sequence in the own layout, without loss.

use super::measurements::{Contents, Measurement};
use super::metadata::texts;
use super::target::refuse_other_folder;
use crate::disk::files;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::read::recording::{check_motion_corrected, check_nothing_lost};
use crate::result::{OutFolder, SequenceNames, WriterLock, own_folder, refuse_links_out};
use crate::tree::SEQUENCES;
use ralf_jobs::side_by_side;
use std::fs;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// The file by which a sequence that is not whole yet is known as ours.
const MARK: &str = ".ralf-unfinished";

/// Writes a sequence as `DATASET/sequences/NAME`, whole or not at all: it lies in a hidden folder until it is complete.
///
/// Radar columns, LiDAR points, label, truth, cause and image files are written as they are. `progress` is told how
/// many measurements are done. An existing sequence is never overwritten ([`has_sequence`](super::has_sequence) tells
/// whether it is this one), and a measurement that can't be read is an error.
///
/// # Errors
/// `DATASET` holds labels or is a recording of another format, a sequence of this name is there, one of its names leads
/// elsewhere, or something of it can't be read or written.
pub fn write_sequence(
    reader: &dyn SequenceReader,
    dataset: &Path,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<(), DataError> {
    write_sequence_with(reader, dataset, 1, progress)
}

/// Writes a sequence as [`write_sequence`] does, with so many threads. The files are the same to the byte whatever
/// their number, and so is the error.
pub fn write_sequence_with(
    reader: &dyn SequenceReader,
    dataset: &Path,
    jobs: usize,
    progress: &(dyn Fn(usize) + Sync),
) -> Result<(), DataError> {
    refuse_other_folder(dataset)?;
    let names = SequenceNames::new(reader.sequence())?;
    check_nothing_lost(reader)?;
    check_motion_corrected(reader)?;
    let sequences = OutFolder::new(dataset).own(SEQUENCES);
    let folder = sequences.folder(&names.sequence);
    let folder = folder.path();
    if folder.exists() {
        return Err(DataError::content(folder, "folder", "none of this name yet", "one"));
    }
    refuse_links_out(dataset, SEQUENCES, 0)?;
    let _lock = WriterLock::beside(folder)?;
    let part = sequences.folder(&names.sequence.hidden(".part"));
    own_folder::begin(&part, MARK)?;
    let writer = Writer { reader, names: &names, folder: &part, done: Mutex::new(0), progress };
    let written = writer.write(jobs).and_then(|()| {
        files::remove(&part.own_file(MARK))?;
        fs::rename(part.path(), folder).map_err(DataError::io(folder))
    });
    if written.is_err() {
        // The unfinished folder is of no use to anyone; the error that matters is the first one.
        let _ = own_folder::remove(part.path(), MARK);
    }
    written
}

struct Writer<'a> {
    reader: &'a dyn SequenceReader,
    names: &'a SequenceNames,
    folder: &'a OutFolder,
    done: Mutex<usize>,
    progress: &'a (dyn Fn(usize) + Sync),
}

impl Writer<'_> {
    fn write(&self, jobs: usize) -> Result<(), DataError> {
        let sequence = self.reader.sequence();
        for (file, text) in texts(sequence, self.names, self.folder)? {
            files::write_whole(&file, text.as_bytes())?;
        }
        let contents = Contents::new(self.reader, self.names, self.folder)?;
        side_by_side(&Measurement::all(&sequence.times), jobs, |measurement| {
            for (file, bytes) in contents.of(*measurement)? {
                files::write_whole(&file, &bytes)?;
            }
            let mut done = self.done.lock().unwrap_or_else(PoisonError::into_inner);
            *done += 1;
            (self.progress)(*done);
            Ok::<(), DataError>(())
        })?;
        match contents.names_of_causes()? {
            Some((file, names)) => files::write_whole(&file, &names),
            None => Ok(()),
        }
    }
}
