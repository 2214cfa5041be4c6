//! Labels of another recording: what somebody has labelled, and may have corrected, isn't replaced unawares.

use super::inputs::Identity;
use super::unfinished::Finished;
use crate::error::DataError;
use crate::result::{Input, RunRecord, SequenceRecord};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

/// So many sequences are named.
const SHOWN: usize = 5;

/// What an output folder tells of its labels.
pub(super) struct Labelled<'a> {
    /// Its record, where there is one.
    pub(super) record: Option<&'a RunRecord>,
    /// What killed runs have finished.
    pub(super) finished: &'a [Finished],
    /// Whether sequences that aren't asked for stay.
    pub(super) stays: bool,
}

/// Where a recording lies, the same by all its names; empty where it isn't on disk.
pub(super) fn place_of(recording: &Path) -> String {
    recording.canonicalize().map_or_else(|_| String::new(), |place| place.to_string_lossy().into_owned())
}

/// Refuses a recording for which labels of another one would go: those under the same names, and all of them where
/// labels of other settings can't stay beside what is asked for.
///
/// Another one lies elsewhere, and hardly any file of its sequences is what was labelled. One that was moved is the
/// same, and so is one that changed where it lies. Of labels whose place an older record doesn't tell nobody knows.
pub(super) fn refuse_other_recording(
    record_file: &Path,
    labelled: &Labelled,
    recording: &Path,
    asked: &[Identity],
) -> Result<(), DataError> {
    let told: Vec<&Identity> = asked.iter().filter(|asked| asked.is_told).collect();
    let inputs = labelled.inputs();
    let is_read_from = |known: &SequenceRecord, asked: &Identity| {
        let earlier = inputs.get(known.name.as_str()).map(Vec::as_slice).unwrap_or_default();
        known.fingerprint == asked.fingerprint || are_of_one_recording(earlier, &asked.inputs)
    };
    let of_name = |known: &SequenceRecord| told.iter().copied().find(|asked| asked.name == known.name);
    let all: Vec<&SequenceRecord> = labelled.sequences().collect();
    let same = all.iter().filter(|known| of_name(known).is_some_and(|asked| is_read_from(known, asked)));
    // Where the recording lies, and where it lay.
    let own: BTreeSet<String> =
        same.map(|known| known.recording.clone()).chain([place_of(recording)]).collect();
    let goes = |known: &&&SequenceRecord| match of_name(known) {
        Some(asked) => known.fingerprint != asked.fingerprint,
        None => !labelled.stays,
    };
    let is_others = |known: &&&SequenceRecord| !known.recording.is_empty() && !own.contains(&known.recording);
    let lost: Vec<&SequenceRecord> = all.iter().filter(goes).filter(is_others).copied().collect();
    let Some(first) = lost.first() else { return Ok(()) };
    let names: Vec<&str> = lost.iter().map(|known| known.name.as_str()).collect();
    let expected = format!("labels of {}, or none that would go", recording.display());
    Err(DataError::content(record_file, "recording", expected, found(first, &names)))
}

fn found(other: &SequenceRecord, names: &[&str]) -> String {
    let more = match names.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let named = names[..names.len().min(SHOWN)].join(", ");
    format!(
        "those of another recording, {}, which would go ({named}{more}): label into another folder, or move these \
         labels away",
        other.recording
    )
}

impl<'a> Labelled<'a> {
    fn sequences(&self) -> impl Iterator<Item = &'a SequenceRecord> + use<'a> {
        let recorded = self.record.into_iter().flat_map(|record| &record.sequences);
        recorded.chain(self.finished.iter().map(|(sequence, _)| sequence))
    }

    /// What was labelled, by sequence.
    fn inputs(&self) -> BTreeMap<&'a str, Vec<&'a Input>> {
        let recorded = self.record.into_iter().flat_map(|record| &record.inputs);
        let finished = self.finished.iter().flat_map(|(_, inputs)| inputs);
        let mut found = BTreeMap::<&str, Vec<&Input>>::new();
        for input in recorded.chain(finished) {
            found.entry(input.sequence.as_str()).or_default().push(input);
        }
        found
    }
}

/// Whether half of the files, or of the bytes, of the smaller list are in the other one, too: recordings of one vehicle
/// have calibrations and times in common, and a file that changed may be a large one. Of a list without content nothing
/// is known.
fn are_of_one_recording(earlier: &[&Input], now: &[Input]) -> bool {
    let [earlier, now] = [contents(earlier.iter().copied()), contents(now)];
    let Some(smaller) = [&earlier, &now].into_iter().min_by_key(|files| files.len()) else { return true };
    let shared: BTreeSet<_> = earlier.intersection(&now).copied().collect();
    2 * shared.len() >= smaller.len() || 2 * bytes(&shared) >= bytes(&earlier).min(bytes(&now))
}

/// Files that hold something, by their hashes.
fn contents<'a>(files: impl IntoIterator<Item = &'a Input>) -> BTreeSet<(&'a str, u64)> {
    let holds_some = |file: &&Input| file.bytes > 0 && !file.blake3.is_empty();
    files.into_iter().filter(holds_some).map(|file| (file.blake3.as_str(), file.bytes)).collect()
}

fn bytes(files: &BTreeSet<(&str, u64)>) -> u64 {
    files.iter().map(|(_, bytes)| bytes).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn files(of: &[(&str, u64)]) -> Vec<Input> {
        let file = |(blake3, bytes): &(&str, u64)| Input {
            sequence: "00".to_owned(),
            file: String::new(),
            bytes: *bytes,
            mtime_ns: None,
            blake3: (*blake3).to_owned(),
        };
        of.iter().map(file).collect()
    }

    #[test]
    fn half_of_the_files_or_of_the_bytes_make_one_recording() {
        let earlier = files(&[("calibration", 10), ("a", 500), ("b", 500), ("c", 500)]);
        let is_one = |now: &[(&str, u64)]| {
            let earlier: Vec<&Input> = earlier.iter().collect();
            are_of_one_recording(&earlier, &files(now))
        };
        assert!(is_one(&[("calibration", 10), ("a", 500), ("b", 500), ("d", 500)]));
        // It went on, or most of it was cut off.
        assert!(is_one(&[("calibration", 10), ("a", 500), ("b", 500), ("c", 500), ("d", 9000), ("e", 9000)]));
        assert!(is_one(&[("a", 500)]));
        assert!(is_one(&[("a", 500), ("x", 9), ("y", 9), ("z", 9)]));
        assert!(!is_one(&[("calibration", 10), ("d", 500), ("e", 500), ("f", 500)]));
        // Neither an empty file nor one that can't be read tells anything.
        assert!(!is_one(&[("calibration", 10), ("", 500), ("d", 500), ("e", 500), ("f", 500)]));
        assert!(is_one(&[("", 500)]) && are_of_one_recording(&[], &earlier));
    }
}
