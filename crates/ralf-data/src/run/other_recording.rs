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
}

/// Where a recording lies, the same by all its names; empty where it isn't on disk.
pub(super) fn place_of(recording: &Path) -> String {
    recording.canonicalize().map_or_else(|_| String::new(), |place| place.to_string_lossy().into_owned())
}

/// Refuses a recording where the folder holds labels of another one under the same names.
///
/// Another one lies elsewhere, and hardly any file of its sequences is what was labelled. One that was moved is the
/// same, and so is one that changed where it lies; of names that only one of both has, nobody can tell.
pub(super) fn refuse_other_recording(
    record_file: &Path,
    labelled: &Labelled,
    recording: &Path,
    asked: &[Identity],
) -> Result<(), DataError> {
    let known = |asked: &Identity| labelled.sequence(&asked.name);
    let told = asked.iter().filter(|asked| asked.is_told);
    let both: Vec<_> = told.filter_map(|asked| Some((asked, known(asked)?))).collect();
    let here = place_of(recording);
    let is_here =
        both.iter().any(|(asked, known)| known.recording == here || known.fingerprint == asked.fingerprint);
    let Some((_, other)) = both.first().filter(|_| !is_here) else { return Ok(()) };
    let inputs = labelled.inputs();
    let earlier = |name: &str| inputs.get(name).map(Vec::as_slice).unwrap_or_default();
    if both.iter().any(|(asked, _)| are_of_one_recording(earlier(&asked.name), &asked.inputs)) {
        return Ok(());
    }
    let names: Vec<&str> = both.iter().map(|(asked, _)| asked.name.as_str()).collect();
    let expected = format!("labels of {}, or none of its sequences yet", recording.display());
    Err(DataError::content(record_file, "recording", expected, found(other, &names)))
}

fn found(other: &SequenceRecord, names: &[&str]) -> String {
    let place = match other.recording.as_str() {
        "" => String::new(),
        place => format!(", {place}"),
    };
    let more = match names.len().saturating_sub(SHOWN) {
        0 => String::new(),
        more => format!(" and {more} more"),
    };
    let named = names[..names.len().min(SHOWN)].join(", ");
    format!(
        "those of another recording{place}, with sequences of the same names ({named}{more}): label into another \
         folder, or move these labels away"
    )
}

impl<'a> Labelled<'a> {
    fn sequence(&self, name: &str) -> Option<&'a SequenceRecord> {
        let finished = || self.finished.iter().map(|(sequence, _)| sequence).find(|found| found.name == name);
        self.record.and_then(|record| record.sequence(name)).or_else(finished)
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
