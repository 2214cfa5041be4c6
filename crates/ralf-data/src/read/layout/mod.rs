//! The project's own layout: `sequences/NN/` as SemanticKITTI has it, with what radar needs.
//!
//! Bytes and text as specified lie in [`raw`] and [`tables`]; [`rig`] turns them into sensors and back; [`source`]
//! reads measurements on demand.

mod camera;
mod depth_card;
mod listing;
pub(crate) mod raw;
pub(crate) mod rig;
mod source;
pub(crate) mod tables;
mod values;

pub use source::LayoutSequence;
pub(crate) use values::degrees;

use crate::disk::files;
use crate::error::DataError;
use crate::read::Recording;
use crate::read::incomplete::named;
use crate::read::opened::Opened;
use crate::tree::{ODOMETRY, POSES, RECORD, SENSORS, SEQUENCES};
use ralf::sensors::{DepthOutput, Rig};
use std::path::{Path, PathBuf};

/// The format's name.
pub(crate) const NAME: &str = "ralf";

/// Opens a dataset of the own layout, with every check that needs no measurement; where names are given, those
/// sequences.
///
/// Errors: no sequence; what the checks refuse of a sequence that is named, or of the first where none is left.
pub(crate) fn open(dataset: &Path, names: &[String]) -> Result<Recording, DataError> {
    let folder = dataset.join(SEQUENCES);
    refuse_results(dataset)?;
    let folders: Vec<_> = folders(&folder)?.into_iter().map(|folder| (named(&folder), folder)).collect();
    if folders.is_empty() {
        return Err(DataError::content(&folder, "folder", "a folder per sequence", "none"));
    }
    let opened = Opened::of(folders, names, |_, folder| LayoutSequence::open(&folder))?;
    Ok(opened.recording(dataset, NAME, Vec::new()))
}

/// Sensors, and what depth images mean, told as JSON with the keys of `sequence.toml`, and checked as that is.
///
/// # Errors
/// What the file would be refused for; it is called `sequence.toml`.
pub fn rig_from_json(told: &str) -> Result<(Rig, DepthOutput), DataError> {
    let file = Path::new(SENSORS);
    let told: raw::SequenceToml = serde_json::from_str(told).map_err(|error| {
        DataError::content(file, "sensors", "the keys of docs/formats.md", error.to_string())
    })?;
    Ok((rig::rig(file, &told)?, told.depth.output))
}

/// Refuses the folder that `ralf label` wrote, whose own `sequences` are easily taken for those of a recording.
fn refuse_results(dataset: &Path) -> Result<(), DataError> {
    let expected = "a recording";
    let found = "the labels of one, as `ralf label` wrote them";
    let is_result = dataset.join(RECORD).is_file()
        && folders(&dataset.join(SEQUENCES))?.iter().all(|folder| !folder.join(SENSORS).exists());
    if is_result { Err(DataError::content(dataset, "content", expected, found)) } else { Ok(()) }
}

/// Whether a folder holds labels of sequences, such as their truth, and nothing of what was measured. One whose
/// sequences can't be listed is taken for a recording, so that opening it tells why.
pub(crate) fn holds_labels_alone(dataset: &Path) -> bool {
    let is_measured =
        |folder: &PathBuf| [SENSORS, ODOMETRY, POSES].iter().any(|name| folder.join(name).exists());
    folders(&dataset.join(SEQUENCES)).is_ok_and(|folders| !folders.iter().any(is_measured))
}

/// The folders in a folder by name, hidden ones left out: a conversion under way is one.
fn folders(parent: &Path) -> Result<Vec<PathBuf>, DataError> {
    let mut found = Vec::new();
    for entry in files::entries(parent, "a folder per sequence")? {
        let entry = entry.map_err(DataError::io(parent))?;
        let hidden = entry.file_name().as_encoded_bytes().starts_with(b".");
        if !hidden && entry.path().is_dir() {
            found.push(entry.path());
        }
    }
    found.sort();
    Ok(found)
}

/// Whether a name can be a folder's on every system, and leads nowhere else.
pub(crate) fn is_folder_name(name: &str) -> bool {
    let usual = |c: char| !c.is_control() && !"/\\:*?\"<>|".contains(c);
    !name.is_empty() && !name.starts_with('.') && name.chars().all(usual)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing;

    #[test]
    fn a_damaged_sequence_costs_the_others_nothing() {
        let dataset = tempfile::tempdir().unwrap();
        let made = ralf_sim::presets::find("tiny").unwrap().sequences[0].simulate(2, 1).unwrap();
        crate::write_sequence(&made, dataset.path(), &|_| ()).unwrap();
        let sensors = dataset.path().join("sequences/other").join(SENSORS);
        testing::write(&sensors, b"format =");
        testing::check_left_out(dataset.path(), ["tiny", "other"], "other/sequence.toml: line 1");
    }
}
