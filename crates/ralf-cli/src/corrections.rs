//! The truth with what people corrected in a review.

use crate::outcome::Outcome;
use crate::progress::say;
use anyhow::anyhow;
use ralf_data::{Corrections, GroundTruth, Recording, partly_corrected, told_partly_corrected};
use ralf_report::told_corrections;
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
    let outcome = say_orphaned(&corrections.told_orphaned());
    if corrections.is_empty() && asked {
        let has_others = recording.is_some() && !Corrections::open(out)?.is_empty();
        return Err(none_of(&corrections, dataset, has_others));
    }
    if !corrections.is_empty() {
        say(&told(&corrections, "merged into the truth"));
    }
    Ok((GroundTruth::merged(dataset, corrections)?, outcome))
}

/// Warns where the truth of scans is but what people corrected there.
pub(crate) fn say_partly_corrected(truth: &GroundTruth) {
    let sentence = told_partly_corrected(partly_corrected(truth));
    if let (Some(corrections), Some(sentence)) = (truth.corrections(), sentence) {
        say(&format!("{}: {sentence}", corrections.file().display()));
    }
}

/// What people corrected and accepted in an output folder of a recording, which is said, and nothing else; there must
/// be something. Corrections of scans that hold something else now are named and left out; the outcome tells.
pub(crate) fn said_truth(recording: &Recording, out: &Path) -> anyhow::Result<(GroundTruth, Outcome)> {
    Corrections::check_there(out)?;
    let corrections = Corrections::of_recording(out, recording)?;
    let outcome = say_orphaned(&corrections.told_orphaned());
    let said = told(&corrections, "learned");
    let none = none_of(&corrections, &recording.path, !Corrections::open(out)?.is_empty());
    let truth = GroundTruth::of_corrections(&recording.path, corrections).ok_or(none)?;
    say(&said);
    Ok((truth, outcome))
}

/// How much was said, and what becomes of it.
fn told(corrections: &Corrections, are: &str) -> String {
    format!("{}: {}", corrections.file().display(), told_corrections(corrections, are))
}

/// Corrections that were asked for and aren't there, though others may be.
fn none_of(corrections: &Corrections, dataset: &Path, has_others: bool) -> anyhow::Error {
    let fitting = if has_others { format!(" that fit {}", dataset.display()) } else { String::new() };
    anyhow!("{}: expected corrections, found none{fitting}", corrections.file().display())
}

/// Says of each scan whose corrections don't count why that is so, and tells how it ended by that.
pub(crate) fn say_orphaned(told: &[String]) -> Outcome {
    told.iter().for_each(|sentence| say(sentence));
    Outcome::done_if(told.is_empty())
}
