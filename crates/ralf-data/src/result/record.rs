//! `run.json`: what was done, with what, and how it went.

use super::check_record::CheckRecord;
use super::json::read_json;
use super::sequence_record::{CameraRecord, NotLabelled, RadarRecord, SequenceRecord, UnreadableScan};
use super::under_way;
use crate::disk::files;
use crate::error::DataError;
use crate::read::Recording;
use crate::settings::Settings;
use crate::tree::RECORD;
use ralf::learned::Model;
use serde::{Deserialize, Serialize};
use std::collections::BTreeSet;
use std::path::Path;

/// The content of `run.json`: sequences that were labelled by one version of the program with the same settings, be it
/// at once or one after the other.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Version of the program.
    pub version: String,
    /// A hash of the sources that the program was built from, as far as labels depend on them. An older record has
    /// none.
    #[serde(default)]
    pub program: String,
    /// Format of the recording.
    pub format: String,
    /// All settings, resolved.
    pub settings: Settings,
    /// Whether evidence was gathered, too.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub evidence: bool,
    /// A hash of the model that answered, where one did.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub model: Option<String>,
    /// Every file that was read, by sequence and name.
    pub inputs: Vec<Input>,
    /// In the order of their names.
    pub sequences: Vec<SequenceRecord>,
    /// What the check at the head of a run said, by sequence.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub check: Vec<CheckRecord>,
    /// Of the last run; the only part that differs from run to run of a recording in one place.
    pub timings: Timings,
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    /// Name of the sequence that it was read for.
    pub sequence: String,
    /// Relative to the recording; a whole path where it lies elsewhere, as depth beside the labels does.
    pub file: String,
    /// Its size.
    pub bytes: u64,
    /// When it was changed last before it was read, ns since 1970: a file of this size and time is taken for the same.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mtime_ns: Option<i64>,
    /// Of its content; empty where it can't be read.
    pub blake3: String,
}

impl Input {
    /// What the record calls a file of the recording at `root`: the same from wherever the program is started.
    pub(crate) fn name(file: &Path, root: &Path) -> String {
        let name = match file.strip_prefix(root) {
            Ok(within) => within.to_owned(),
            Err(_) => {
                let whole = files::whole(file);
                whole.strip_prefix(files::whole(root)).map(Path::to_owned).unwrap_or(whole)
            }
        };
        name.to_string_lossy().into_owned()
    }
}

/// How long it took.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Timings {
    /// Wall time of the whole run, s.
    pub seconds: f64,
    /// Threads.
    pub jobs: usize,
}

/// Which program this is: its version and a hash of the sources that labels depend on.
pub fn program() -> String {
    format!("{} {}", env!("CARGO_PKG_VERSION"), env!("RALF_SOURCES"))
}

/// What an output folder holds: its `run.json`.
pub fn read_record(out: &Path) -> Result<RunRecord, DataError> {
    let file = out.join(RECORD);
    if !file.exists() {
        let found = match out.exists() {
            false => "no such folder",
            true if under_way::is_under_way(out)? => under_way::FOUND,
            true => "no such file",
        };
        return Err(DataError::content(out, RECORD, "the record of a finished `ralf label`", found));
    }
    read_json(&file)
}

impl RunRecord {
    /// The record of a folder that holds no sequence yet.
    pub(crate) fn new(
        recording: &Recording,
        settings: &Settings,
        evidence: bool,
        model: Option<&Model>,
    ) -> Self {
        Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            program: env!("RALF_SOURCES").to_owned(),
            format: recording.format.to_owned(),
            settings: settings.anywhere(),
            evidence,
            model: model.map(|model| blake3::hash(model.to_text().as_bytes()).to_hex().to_string()),
            inputs: Vec::new(),
            sequences: Vec::new(),
            check: Vec::new(),
            timings: Timings::default(),
        }
    }

    /// Whether the sequences of both may stand side by side.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        let program =
            |run: &Self| (run.version.clone(), run.program.clone(), run.evidence, run.model.clone());
        program(self) == program(other) && (&self.format, &self.settings) == (&other.format, &other.settings)
    }

    /// A sequence of this name.
    pub fn sequence(&self, name: &str) -> Option<&SequenceRecord> {
        self.sequences.iter().find(|sequence| sequence.name == name)
    }

    /// Adds sequences, which it does not have, with their inputs.
    pub(crate) fn add(&mut self, sequences: impl IntoIterator<Item = (SequenceRecord, Vec<Input>)>) {
        for (sequence, inputs) in sequences {
            self.sequences.push(sequence);
            self.inputs.extend(inputs);
        }
        self.sequences.sort_by(|a, b| a.name.cmp(&b.name));
        self.inputs.sort_by(|a, b| (&a.sequence, &a.file).cmp(&(&b.sequence, &b.file)));
    }

    /// What was checked anew takes the place of what was said before.
    pub(crate) fn add_checks(&mut self, checks: &[CheckRecord]) {
        self.check.retain(|known| checks.iter().all(|new| new.sequence != known.sequence));
        self.check.extend(checks.iter().cloned());
        self.check.sort_by(|a, b| a.sequence.cmp(&b.sequence));
    }

    /// Keeps sequences, with their inputs and what the check said of them.
    pub fn retain(&mut self, names: impl Fn(&SequenceRecord) -> bool) {
        self.sequences.retain(names);
        let left: BTreeSet<&str> = self.sequences.iter().map(|sequence| sequence.name.as_str()).collect();
        self.inputs.retain(|input| left.contains(input.sequence.as_str()));
        self.check.retain(|check| left.contains(check.sequence.as_str()));
    }

    /// Radars whose labels are to be doubted, each for one of the reasons below: sequence, radar, what there is to say.
    pub fn doubtful_radars(&self) -> impl Iterator<Item = (&str, &str, String)> {
        let told = self.radars_without_numbers().chain(self.radars_unlike_sisters());
        told.chain(self.radars_hardly_plausible())
    }

    /// Radars that have detections and no numbers: sequence, radar, what there is to say.
    pub fn radars_without_numbers(&self) -> impl Iterator<Item = (&str, &str, String)> {
        named(&self.sequences, SequenceRecord::radars_without_numbers)
    }

    /// Radars whose plausible share is far from that of the others: sequence, radar, what there is to say.
    pub fn radars_unlike_sisters(&self) -> impl Iterator<Item = (&str, &str, String)> {
        named(&self.sequences, SequenceRecord::radars_unlike_sisters)
    }

    /// Radars that have numbers and hardly any plausible detection, but for those that are told as unlike the others:
    /// sequence, radar, what there is to say.
    pub fn radars_hardly_plausible(&self) -> impl Iterator<Item = (&str, &str, String)> {
        named(&self.sequences, SequenceRecord::radars_hardly_plausible)
    }

    /// Scans that could not be labelled, with their sequence.
    pub fn not_labelled(&self) -> impl Iterator<Item = (&str, &NotLabelled)> {
        self.sequences
            .iter()
            .flat_map(|sequence| sequence.not_labelled.iter().map(|scan| (sequence.name.as_str(), scan)))
    }

    /// What of the recording is lost and may have held scans, with its sequence.
    pub fn lost(&self) -> impl Iterator<Item = (&str, &str)> {
        self.sequences
            .iter()
            .flat_map(|sequence| sequence.lost.iter().map(|lost| (sequence.name.as_str(), lost.as_str())))
    }

    /// LiDAR scans that labelling had to do without, for they can't be read, with their sequence.
    pub fn unreadable(&self) -> impl Iterator<Item = (&str, &UnreadableScan)> {
        self.sequences
            .iter()
            .flat_map(|sequence| sequence.unreadable.iter().map(|scan| (sequence.name.as_str(), scan)))
    }

    /// All cameras of all sequences.
    pub fn cameras(&self) -> impl Iterator<Item = &CameraRecord> {
        self.sequences.iter().flat_map(|sequence| &sequence.cameras)
    }

    /// All radars of all sequences.
    pub fn radars(&self) -> impl Iterator<Item = &RadarRecord> {
        self.sequences.iter().flat_map(|sequence| &sequence.radars)
    }
}

/// What is said of the radars of all sequences: sequence, radar, what there is to say.
fn named<'a>(
    sequences: &'a [SequenceRecord],
    told: impl Fn(&'a SequenceRecord) -> Vec<(&'a str, String)>,
) -> impl Iterator<Item = (&'a str, &'a str, String)> {
    sequences.iter().flat_map(move |sequence| {
        told(sequence).into_iter().map(|(radar, words)| (sequence.name.as_str(), radar, words))
    })
}
