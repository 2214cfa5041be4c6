//! The truth with what people corrected in a review.

use crate::outcome::Outcome;
use crate::progress::say;
use crate::text::grouped;
use anyhow::bail;
use ralf_data::{Corrections, GroundTruth, Recording, told_orphaned};
use std::fmt::Display;
use std::path::Path;

/// The dataset's truth with the corrections of an output folder above it, which is said. Where they were asked for
/// there must be some that fit the recording. Corrections of scans that hold something else now are named and left out,
/// where the recording can be read; the outcome tells.
pub(crate) fn merged_truth(
    dataset: &Path,
    recording: Option<&Recording>,
    out: Option<&Path>,
    asked: bool,
) -> anyhow::Result<(GroundTruth, Outcome)> {
    let Some(out) = out else { return Ok((GroundTruth::open(dataset)?, Outcome::Done)) };
    if asked {
        Corrections::check_there(out)?;
    }
    let corrections = match recording {
        Some(recording) => Corrections::of_recording(out, recording)?,
        None => Corrections::open(out)?,
    };
    let outcome = say_orphaned(corrections.orphaned());
    let file = corrections.file().display();
    if corrections.is_empty() && asked {
        let has_others = recording.is_some() && !Corrections::open(out)?.is_empty();
        let fitting = if has_others { format!(" that fit {}", dataset.display()) } else { String::new() };
        bail!("{file}: expected corrections, found none{fitting}");
    }
    if !corrections.is_empty() {
        say(&format!(
            "{file}: {} corrected detections and {} reviewed scans are merged into the truth",
            grouped(corrections.corrected_detections() as u64),
            grouped(corrections.reviewed_scans() as u64)
        ));
    }
    Ok((GroundTruth::merged(dataset, corrections)?, outcome))
}

/// Names the scans whose corrections belong to another content, and tells how it ended by that.
pub(crate) fn say_orphaned(scans: &[impl Display]) -> Outcome {
    scans.iter().for_each(|scan| say(&told_orphaned(scan)));
    Outcome::done_if(scans.is_empty())
}
