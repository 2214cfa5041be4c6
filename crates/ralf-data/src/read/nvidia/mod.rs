//! NVIDIA's PhysicalAI-Autonomous-Vehicles: the radars of a clip, and how the vehicle moved; Parquet tables.
//!
//! - The path is the data set's folder with the clip files unzipped where they lay (`radar/NAME/CLIP.NAME.parquet`), a
//!   clip's folder (`radar/CLIP.NAME.parquet`), or what holds folders of clips. A clip is a sequence.
//! - A scan is the rows of one `scan_index`, wherever they lie, at the median of their `sensor_timestamp`, us: when
//!   they were measured. Where that is not told, it is at their `timestamp`: when its cycle began. Columns are as
//!   published: `distance` is `range`, `radial_velocity` is `doppler`, the raw range rate; `exist_probb`, what the
//!   sensor itself believes, is kept. No row is dropped; one whose distance isn't above 0 has no place.
//! - Poses are those of `egomotion.offline`, else of `egomotion`: the vehicle's frame is RALF's. So are mountings.
//! - The LiDAR is compressed with Draco, of which there is no decoder in Rust that could be relied on: it is left out.
//!   So are the cameras: films behind f-theta lenses.

mod calibration;
mod layout;
mod source;
mod tables;

use crate::error::DataError;
use crate::read::Recording;
use crate::read::last_read::LastRead;
use crate::read::opened::Opened;
use source::{Drive, Shared};
use std::path::Path;
use std::sync::Arc;

/// The format's name.
pub(crate) const NAME: &str = "nvidia";

/// The most radars that a clip has.
const MOST_RADARS: usize = 19;

/// Opens a clip or several; where names are given, those.
///
/// Errors: no clip, zipped files. Of a clip that is named, or if all are such: no mountings, damaged files.
pub(crate) fn open(path: &Path, names: &[String]) -> Result<Recording, DataError> {
    let clips = layout::clips(path)?;
    if clips.is_empty() {
        let (expected, found) =
            ("radar/NAME/CLIP.NAME.parquet or radar/CLIP.NAME.parquet", layout::instead(path)?);
        return Err(DataError::content(path, "files", expected, found));
    }
    let extrinsics = calibration::Extrinsics::default();
    let shared =
        Shared { scans: Arc::new(LastRead::new(tables::table, MOST_RADARS)), extrinsics: &extrinsics };
    let clips = clips.into_iter().collect();
    let opened = Opened::of(clips, names, |name, clip| Drive::new(name, &clip, &shared))?;
    Ok(opened.recording(path, NAME, Vec::new()))
}

/// Whether a folder looks like clips of this data set, zipped or not.
pub(crate) fn recognises(path: &Path) -> bool {
    layout::clips(path).is_ok_and(|clips| !clips.is_empty()) || layout::is_zipped(path)
}

#[cfg(test)]
mod tests;
