//! Whether a folder can take the results of a run: asked before anything is done for them.

use crate::disk::files;
use crate::error::DataError;
use crate::read::refuse_to_write_into;
use crate::result::{OutFolder, is_under_way};
use crate::tree::{RECORD, SEQUENCES, TABLE, sensors_file, sequence_folder};
use serde::Deserialize;
use serde::de::IgnoredAny;
use std::path::Path;

/// Refuses a part of the recording, any other recording, a file in the place of the folder or of the sequences' own,
/// and what is no file, or somebody else's, in that of the record.
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

/// Labels among measurements would be taken for a part of them.
fn refuse_recording(out: &Path) -> Result<(), DataError> {
    let sequences = files::folders(&out.join(SEQUENCES))?;
    match sequences.iter().map(|name| sensors_file(out, name)).find(|file| file.is_file()) {
        None => Ok(()),
        Some(file) => {
            let found = format!("a recording, with {}", file.display());
            Err(DataError::content(out, "output", "a folder of labels, or nothing yet", found))
        }
    }
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
        return Ok(());
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

fn has_results(out: &Path) -> Result<bool, DataError> {
    let sequences = files::folders(&out.join(SEQUENCES))?;
    let has_table = sequences.iter().any(|name| sequence_folder(out, name).join(TABLE).is_file());
    Ok(has_table || is_under_way(out)?)
}
