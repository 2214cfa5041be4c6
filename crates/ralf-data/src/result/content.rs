//! Sizes and hashes of files: whether they are still what a record tells of.

use super::record::Input;
use super::sequence_record::{FileRecord, RadarRecord, SequenceRecord};
use super::{Component, Places};
use crate::disk::files;
use crate::disk::hash::hash;
use crate::error::DataError;
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::time::UNIX_EPOCH;

/// Hashes a file. `advance` is told how many bytes more are done.
pub(crate) fn hash_file(file: &Path, advance: &dyn Fn(u64)) -> Result<FileRecord, DataError> {
    let (bytes, blake3) = hash(file, advance)?;
    Ok(FileRecord { bytes, blake3 })
}

/// When a file was changed last, ns since 1970; `None` where the system doesn't tell.
pub(crate) fn changed_ns(meta: &fs::Metadata) -> Option<i64> {
    let time = meta.modified().ok()?.duration_since(UNIX_EPOCH).ok()?;
    i64::try_from(time.as_nanos()).ok()
}

/// Whether an input still has the content that was labelled: size and time first, the content where the time differs.
pub(crate) fn input_is_unchanged(file: &Path, input: &Input) -> Result<bool, DataError> {
    // It could not be read when the run read the others, and nothing was made from it.
    if input.blake3.is_empty() {
        return Ok(hash_file(file, &|_| {}).is_err());
    }
    let meta = match fs::metadata(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
        meta => meta.map_err(DataError::io(file))?,
    };
    if meta.len() != input.bytes {
        return Ok(false);
    }
    if input.mtime_ns.is_some() && changed_ns(&meta) == input.mtime_ns {
        return Ok(true);
    }
    Ok(hash_file(file, &|_| {})?.blake3 == input.blake3)
}

/// The first of a sequence's results that isn't there, or not as it was written; `None` where all are.
pub(crate) fn damaged_result(places: &Places, record: &SequenceRecord) -> Result<Option<PathBuf>, DataError> {
    // A record that somebody has edited leads nowhere else, and tells of no result.
    let Ok(sequence) = Component::new(&record.name) else { return Ok(Some(PathBuf::from(&record.name))) };
    let table = places.plausibility_file(&sequence);
    if !table_is_whole(&table, record)? {
        return Ok(Some(table));
    }
    for radar in &record.radars {
        let Ok(folder) = Component::new(&radar.name) else { return Ok(Some(PathBuf::from(&radar.name))) };
        for scan in 0..radar.detections.len() {
            let file = places.label_file(&sequence, &folder, scan);
            let expected =
                record.not_labelled.iter().all(|other| (&other.radar, other.scan) != (&radar.name, scan));
            if expected && !labels_are_whole(&file, radar, scan)? {
                return Ok(Some(file));
            }
        }
    }
    Ok(None)
}

/// Whether the table of a sequence is as it was written; one of an older record has only to be there.
pub(crate) fn table_is_whole(file: &Path, record: &SequenceRecord) -> Result<bool, DataError> {
    let meta = match fs::metadata(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(false),
        meta => meta.map_err(DataError::io(file))?,
    };
    let Some(written) = &record.table else { return Ok(meta.is_file()) };
    Ok(meta.is_file() && meta.len() == written.bytes && hash_file(file, &|_| {})? == *written)
}

/// Whether the labels of a scan are as they were written.
fn labels_are_whole(file: &Path, radar: &RadarRecord, scan: usize) -> Result<bool, DataError> {
    match fs::metadata(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(false),
        Err(error) => Err(DataError::io(file)(error)),
        Ok(meta) if meta.len() != 4 * u64::from(radar.detections[scan]) => Ok(false),
        Ok(_) => Ok(radar.labels_match(scan, &files::read(file)?)),
    }
}
