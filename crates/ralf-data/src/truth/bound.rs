//! Corrections of a recording's scans as these are now: what was said of another content is kept, told, and never
//! applied.

use super::content::HeldContent;
use super::{Corrections, ScanId};
use crate::error::DataError;
use crate::read::{Recording, ros};
use crate::result::LabelledRun;
use ralf::sensors::SourceError;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

impl Corrections {
    /// Reads what is said below an output folder of the sequences of a recording, and looks what each scan holds now:
    /// what was said of another content, or of a scan that can't be read, is [orphaned](Self::orphaned).
    ///
    /// # Errors
    /// A file that is no store of corrections, or one of another version of the program.
    pub fn of_recording(out: &Path, recording: &Recording) -> Result<Self, DataError> {
        let corrections = Self::open(out)?.of_sequences(recording);
        let mut unread = BTreeMap::new();
        let bound = corrections.bound(|scan| {
            let content = content_now(recording, scan).transpose();
            Ok::<_, DataError>(content.unwrap_or_else(|error| {
                unread.insert(scan.clone(), error.to_string());
                None
            }))
        });
        bound.map(|bound| bound.with_unread(unread))
    }
}

/// The sequences that were labelled, where a run is told, or of which people said something below an output folder,
/// and which the recording doesn't have any more. A ROS recording is one sequence, and a folder may take the labels of
/// several: of these nothing is lost.
///
/// # Errors
/// A file that is no store of corrections, or one of another version of the program.
pub fn lost_sequences(
    out: &Path,
    run: Option<&LabelledRun>,
    recording: &Recording,
) -> Result<BTreeSet<String>, DataError> {
    if recording.format == ros::NAME {
        return Ok(BTreeSet::new());
    }
    let corrections = Corrections::open(out)?;
    let said = corrections.scans_ever().map(|scan| &scan.sequence);
    let labelled = run.into_iter().flat_map(|run| run.record().sequences.iter().map(|found| &found.name));
    let mut lost: BTreeSet<String> = said.chain(labelled).cloned().collect();
    lost.retain(|name| recording.sequences.iter().all(|reader| reader.sequence().name != *name));
    Ok(lost)
}

/// What a scan of a recording holds, or why it can't be read; `None` of one that isn't there.
fn content_now(recording: &Recording, scan: &ScanId) -> Option<Result<HeldContent, SourceError>> {
    let reader = recording.sequences.iter().find(|reader| reader.sequence().name == scan.sequence)?;
    let at = scan.place_in(reader.sequence())?;
    Some(HeldContent::read(reader.as_ref(), at))
}
