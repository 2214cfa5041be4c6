//! The truth with what people corrected in a review.

use crate::progress::say;
use crate::text::grouped;
use anyhow::bail;
use ralf_data::{Corrections, GroundTruth};
use std::path::Path;

/// The dataset's truth with the corrections of an output folder above it, which is said. Where they were asked for
/// there must be some.
pub(crate) fn merged_truth(dataset: &Path, out: Option<&Path>, asked: bool) -> anyhow::Result<GroundTruth> {
    let corrections = out.map(Corrections::open).transpose()?.filter(|found| asked || !found.is_empty());
    let Some(corrections) = corrections else { return Ok(GroundTruth::open(dataset)?) };
    let file = corrections.file().display();
    if corrections.is_empty() {
        bail!("{file}: expected corrections, found none");
    }
    say(&format!(
        "{file}: {} corrected detections and {} reviewed scans are merged into the truth",
        grouped(corrections.corrected_detections() as u64),
        grouped(corrections.reviewed_scans() as u64)
    ));
    Ok(GroundTruth::merged(dataset, corrections)?)
}
