//! The Radar Ghost Dataset, version 1.1: an HDF5 file per sequence, with a table of radar detections and one of LiDAR
//! points. The vehicle stands.
//!
//! - The path is a file, a folder of files, or what holds `train`, `val` and `test` of `original`, `virtual` or both. A
//!   sequence is named after its file.
//! - A radar's scan is what one radar saw in one `frame`; its time is the `timestamp` of its first row. Columns are as
//!   published: `phi_sc` is `azimuth`, `r_sc` is `range`, `vr_sc` is `doppler`, `amp`, `x_cc` and `y_cc` keep their
//!   names. `amp` has no published unit, so that nothing takes it for decibels.
//! - A LiDAR's scan is the points of one `timestamp`, brought from the car's frame to the LiDAR's. They have no
//!   intensity.
//! - Times count from the recording's begin in a unit that the data set doesn't say; the time between two scans tells
//!   it. Of a table with a single time the other one tells it.
//! - Mountings are those of the data set's page. The car's frame begins at some height above the road, which is nowhere
//!   said.
//! - `label_id` is the truth, never a column that labels could be made from: [`labels`] says what becomes of it.
//! - Version 1.0 is refused: its LiDAR isn't synchronised with its radars.

mod labels;
mod scans;
mod source;
mod tables;

use crate::disk::files;
use crate::error::DataError;
use crate::read::Recording;
use crate::read::opened::Opened;
use source::{Standing, Tables};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The format's name.
pub(crate) const NAME: &str = "radar-ghost";

/// Opens a sequence, a split, or all of them; where names are given, those.
///
/// Errors: no sequence, two of one name. Of one that is named, or if all are such: a damaged file, one of version 1.0.
pub(crate) fn open(path: &Path, names: &[String]) -> Result<Recording, DataError> {
    let mut found = sequence_files(path)?;
    found.sort_by(|a, b| a.file_stem().cmp(&b.file_stem()));
    if let Some(pair) = found.windows(2).find(|pair| pair[0].file_stem() == pair[1].file_stem()) {
        let other = pair[1].display().to_string();
        return Err(DataError::content(&pair[0], "name", "a name that no other sequence has", other));
    }
    if found.is_empty() {
        return Err(DataError::content(path, "files", "sequences, `scenario-*.h5`", "none"));
    }
    let tables = Arc::new(Tables::new());
    let found = found.into_iter().map(|file| (source::name(&file), file)).collect();
    let opened = Opened::of(found, names, |_, file| Standing::new(file, tables.clone()))?;
    Ok(opened.recording(path, NAME, Vec::new()))
}

/// Whether a file is named like a sequence, or a folder holds such files.
pub(crate) fn recognises(path: &Path) -> bool {
    sequence_files(path).is_ok_and(|found| !found.is_empty())
}

/// The files of all sequences: `[original/ | virtual/][train/ | val/ | test/]scenario-*.h5`.
fn sequence_files(path: &Path) -> Result<Vec<PathBuf>, DataError> {
    if path.is_file() {
        return Ok(if is_sequence(path) { vec![path.to_owned()] } else { Vec::new() });
    }
    let kinds = ["", "original", "virtual"].map(|kind| path.join(kind));
    let splits = ["", "train", "val", "test"];
    let mut found = Vec::new();
    for folder in kinds.iter().flat_map(|kind| splits.map(|split| kind.join(split))) {
        let below = files::names(&folder)?.into_iter().map(|name| folder.join(name));
        found.extend(below.filter(|file| is_sequence(file) && file.is_file()));
    }
    Ok(found)
}

fn is_sequence(file: &Path) -> bool {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    name.starts_with("scenario-") && name.ends_with(".h5")
}

#[cfg(test)]
mod tests;
