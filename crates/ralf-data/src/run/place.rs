//! Whether a folder can take the results of a run: asked before anything is done for them.

use crate::disk::files;
use crate::error::DataError;
use crate::read::open::refuse_other_format;
use crate::read::{refuse_own_places, refuse_to_write_into};
use crate::result::{OutFolder, is_under_way};
use crate::tree::{LABELS, PLAN, RECORD, SEQUENCES, TABLE, sensors_file, sequence_folder};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::path::{Path, PathBuf};

/// Refuses a part of a recording, any other recording, a file in the place of the folder or of the sequences' own, what
/// is no file, or somebody else's, in that of the record, and labels that no run has made.
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
    refuse_recording(out)?;
    refuse_other_record(out, &record)
}

/// Refuses a folder for the folders of many recordings' results that is a recording or holds one's results itself, or
/// lies in one or among results.
///
/// # Errors
/// Such a place.
pub(crate) fn check_folder_of_many(out: &Path) -> Result<(), DataError> {
    refuse_own_places(out)?;
    if files::exists(&out.join(PLAN))? || files::exists(&out.join(RECORD))? || is_under_way(out)? {
        let expected = "a folder for those of recordings, or nothing yet";
        return Err(DataError::content(out, "output", expected, "results of one"));
    }
    refuse_recording(out)
}

/// Labels among measurements would be taken for a part of them.
fn refuse_recording(out: &Path) -> Result<(), DataError> {
    let expected = "a folder of labels, or nothing yet";
    let sequences = files::folders(&out.join(SEQUENCES))?;
    if let Some(file) = sequences.iter().map(|name| sensors_file(out, name)).find(|file| file.is_file()) {
        let found = format!("a recording, with {}", file.display());
        return Err(DataError::content(out, "output", expected, found));
    }
    // Results beside a recording are there already, or are none of ours.
    if out.join(RECORD).is_file() || is_under_way(out)? {
        return Ok(());
    }
    refuse_other_format(out, expected)
}

/// What the record of every version of the program has.
#[derive(Deserialize)]
struct Marks {
    #[serde(rename = "version")]
    _version: String,
    #[serde(rename = "settings")]
    _settings: IgnoredAny,
    #[serde(rename = "sequences")]
    _sequences: IgnoredAny,
}

/// Refuses a `run.json` that no run has written. A record of a run that was damaged is made again: it is known by the
/// results beside it.
fn refuse_other_record(out: &Path, record: &Path) -> Result<(), DataError> {
    if !record.is_file() {
        return refuse_other_labels(out);
    }
    let marks = serde_json::from_slice::<Marks>(&files::read(record)?);
    let is_ours = match marks {
        Ok(_) => true,
        Err(error) => !error.is_data() && has_results(out)?,
    };
    if is_ours {
        return Ok(());
    }
    let expected = "a record of `ralf label`, or nothing yet";
    Err(DataError::content(record, "output", expected, "another file, which would be lost"))
}

/// Refuses labels without a table: people make such, too, and ours have one, though their record may be lost.
fn refuse_other_labels(out: &Path) -> Result<(), DataError> {
    if is_under_way(out)? {
        return Ok(());
    }
    for sequence in real_folders(&out.join(SEQUENCES))? {
        if let Some(file) = labels_alone(&sequence)? {
            let expected = "labels of `ralf label`, or nothing yet";
            let found = format!("{} without a table, which would be lost: move it away", file.display());
            return Err(DataError::content(out, "output", expected, found));
        }
    }
    Ok(())
}

/// The first labels in a sequence's folder that has no table.
fn labels_alone(sequence: &Path) -> Result<Option<PathBuf>, DataError> {
    if sequence.join(TABLE).is_file() {
        return Ok(None);
    }
    for radar in real_folders(sequence)? {
        let mut files = files::names(&radar)?.into_iter().map(|name| radar.join(name));
        if let Some(file) = files.find(|file| file.extension().is_some_and(|ending| ending == LABELS)) {
            return Ok(Some(file));
        }
    }
    Ok(None)
}

/// The folders in a folder, links left out: who would write through one is refused.
fn real_folders(folder: &Path) -> Result<Vec<PathBuf>, DataError> {
    if folder.is_symlink() {
        return Ok(Vec::new());
    }
    let folders = files::folders(folder)?.into_iter().map(|name| folder.join(name));
    Ok(folders.filter(|folder| !folder.is_symlink()).collect())
}

fn has_results(out: &Path) -> Result<bool, DataError> {
    let sequences = files::folders(&out.join(SEQUENCES))?;
    let has_table = sequences.iter().any(|name| sequence_folder(out, name).join(TABLE).is_file());
    Ok(has_table || is_under_way(out)?)
}
