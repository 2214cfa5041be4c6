//! Labels of another recording: what somebody has labelled, and may have corrected, isn't replaced unawares.

use super::inputs::Identity;
use super::kept::{Kept, place_of};
use super::unfinished::Unfinished;
use crate::error::DataError;
use crate::result::{Input, OutFolder, RunRecord, read_record};
use crate::tree::RECORD;
use crate::words::listed;
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

/// So many sequences are named.
const SHOWN: usize = 5;

/// What an output folder tells of its labels.
pub(super) struct Told {
    /// Its record; of one that this version can't read, nothing is known.
    pub(super) record: Option<RunRecord>,
    /// Whether the record's sequences stay beside those that are asked for.
    pub(super) stays: bool,
    record_file: PathBuf,
    /// What runs have kept that are not over.
    kept: Vec<Kept>,
}

/// Labels of a sequence.
struct Labelled<'a> {
    name: &'a str,
    fingerprint: &'a str,
    /// Where its recording lay; empty where nothing tells.
    recording: &'a str,
    inputs: Vec<&'a Input>,
    /// Whether they stay where the sequence isn't asked for.
    stays: bool,
    /// What tells of them.
    file: &'a Path,
}

impl Told {
    /// What the folder `out` tells a run that asks for labels like those of `run`.
    pub(super) fn read(out: &Path, run: &RunRecord) -> Result<Self, DataError> {
        let place = OutFolder::new(out);
        let record = read_record(out).ok();
        let stays = record.as_ref().is_some_and(|record| record.is_like(run));
        let kept = Unfinished::of(&place, run)?.kept()?;
        Ok(Self { record, stays, record_file: place.own_file(RECORD), kept })
    }

    /// Refuses a recording for which labels of another one would go: those under the same names, and all of them where
    /// labels of other settings can't stay beside what is asked for.
    ///
    /// Another one lies elsewhere, and hardly any file of its sequences is what was labelled. One that was moved is the
    /// same, and so is one that changed where it lies. Of labels whose place an older version didn't tell nobody knows.
    pub(super) fn refuse_other_recording(
        &self,
        recording: &Path,
        asked: &[Identity],
    ) -> Result<(), DataError> {
        refuse(&self.labelled(), recording, asked)
    }

    /// Whether labels of a recording that lies elsewhere may go: those of its names, and those that don't stay.
    pub(super) fn may_lose_others(&self, recording: &Path, names: &BTreeSet<&str>) -> bool {
        let place = place_of(recording);
        let may_go = |known: &Labelled| !known.stays || names.contains(known.name);
        let is_others = |known: &Labelled| !known.recording.is_empty() && known.recording != place;
        self.labelled().iter().any(|known| is_others(known) && may_go(known))
    }

    fn labelled(&self) -> Vec<Labelled<'_>> {
        let kept = self.kept.iter().map(Labelled::kept);
        let Some(record) = &self.record else { return kept.collect() };
        Labelled::recorded(record, self.stays, &self.record_file).into_iter().chain(kept).collect()
    }
}

fn refuse(labelled: &[Labelled], recording: &Path, asked: &[Identity]) -> Result<(), DataError> {
    let of_name = |known: &Labelled| asked.iter().find(|asked| asked.is_told && asked.name == known.name);
    let same = labelled.iter().filter(|known| of_name(known).is_some_and(|asked| known.is_read_from(asked)));
    // Where the recording lies, and where it lay.
    let own: BTreeSet<String> =
        same.map(|known| known.recording.to_owned()).chain([place_of(recording)]).collect();
    let goes = |known: &&Labelled| match of_name(known) {
        Some(asked) => known.fingerprint != asked.fingerprint,
        None => !known.stays,
    };
    let is_others = |known: &&Labelled| !known.recording.is_empty() && !own.contains(known.recording);
    let lost: Vec<&Labelled> = labelled.iter().filter(goes).filter(is_others).collect();
    let Some(first) = lost.first() else { return Ok(()) };
    let names = Vec::from_iter(lost.iter().map(|known| known.name).collect::<BTreeSet<_>>());
    let expected = format!("labels of {}, or none that would go", recording.display());
    Err(DataError::content(first.file, "recording", expected, found(first.recording, &names)))
}

fn found(recording: &str, names: &[&str]) -> String {
    let named = listed(names, SHOWN);
    format!(
        "those of another recording, {recording}, which would go ({named}): label into another folder, or move \
         these labels away"
    )
}

impl<'a> Labelled<'a> {
    /// What a record tells, whose sequences stay beside others or don't.
    fn recorded(record: &'a RunRecord, stays: bool, file: &'a Path) -> Vec<Self> {
        let mut inputs = BTreeMap::<&str, Vec<&Input>>::new();
        for input in &record.inputs {
            inputs.entry(input.sequence.as_str()).or_default().push(input);
        }
        let labelled = record.sequences.iter().map(|sequence| Self {
            name: &sequence.name,
            fingerprint: &sequence.fingerprint,
            recording: &sequence.recording,
            inputs: inputs.remove(sequence.name.as_str()).unwrap_or_default(),
            stays,
            file,
        });
        labelled.collect()
    }

    /// What a run has kept that isn't over.
    fn kept(Kept { name, fingerprint, origin, stays, file }: &'a Kept) -> Self {
        let (recording, inputs) = (&origin.recording, origin.inputs.iter().collect());
        Self { name, fingerprint, recording, inputs, stays: *stays, file }
    }

    /// Whether both are of one recording.
    fn is_read_from(&self, asked: &Identity) -> bool {
        self.fingerprint == asked.fingerprint || are_of_one_recording(&self.inputs, &asked.inputs)
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
