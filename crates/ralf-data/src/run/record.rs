//! `run.json`: what was done, with what, and how it went.

use crate::Recording;
use crate::output::ScanTable;
use ralf::camera::{ImageMoment, ViewReport, ViewState};
use ralf::config::Config;
use serde::{Deserialize, Serialize};

/// The content of `run.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct RunRecord {
    /// Version of the program.
    pub version: String,
    /// Of program, settings and inputs together: equal where the results are equal.
    pub fingerprint: String,
    /// Format of the recording.
    pub format: String,
    /// All settings, resolved.
    pub settings: Config,
    /// Every file that was read.
    pub inputs: Vec<Input>,
    /// In the recording's order.
    pub sequences: Vec<SequenceRecord>,
    /// Of this run; the only part that differs from run to run.
    pub timings: Timings,
}

/// A file that was read.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Input {
    /// Relative to the recording.
    pub file: String,
    /// Its size.
    pub bytes: u64,
    /// Of its content.
    pub blake3: String,
}

/// One sequence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SequenceRecord {
    /// Its name.
    pub name: String,
    /// In the rig's order.
    pub radars: Vec<RadarRecord>,
    /// In the rig's order.
    pub cameras: Vec<CameraRecord>,
    /// Scans that could not be labelled.
    pub not_labelled: Vec<NotLabelled>,
    /// Wall time; not part of what is compared.
    #[serde(skip)]
    pub seconds: f64,
}

/// The scans of one radar: one entry per scan in each list.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
pub struct RadarRecord {
    /// The radar's name.
    pub name: String,
    /// Detections.
    pub detections: Vec<u32>,
    /// Of these labelled plausible.
    pub plausible: Vec<u32>,
    /// Flags that any detection of the scan has.
    pub flags: Vec<u16>,
}

/// The images of one camera that were asked about a radar scan and have depth.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CameraRecord {
    /// The camera's name.
    pub name: String,
    /// In their order.
    pub images: Vec<ImageRecord>,
}

/// What the monitor found about an image.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ImageRecord {
    /// Number of the image.
    pub image: usize,
    /// One per straight view.
    pub views: Vec<ViewReport>,
    /// Why all views have failed, where image or depth can't be used at all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub problem: Option<String>,
}

/// A scan that could not be labelled.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct NotLabelled {
    /// The radar's name.
    pub radar: String,
    /// Number of the scan.
    pub scan: usize,
    /// File, place, expected, found.
    pub reason: String,
}

/// How long it took.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Timings {
    /// Wall time of the whole run, s.
    pub seconds: f64,
    /// Threads.
    pub jobs: usize,
}

impl RunRecord {
    /// The record of a run that has yet to label.
    pub(super) fn new(recording: &Recording, config: &Config, inputs: Vec<Input>) -> Self {
        let version = env!("CARGO_PKG_VERSION").to_owned();
        let mut record = Self {
            version,
            fingerprint: String::new(),
            format: recording.format.to_owned(),
            settings: config.clone(),
            inputs,
            sequences: Vec::new(),
            timings: Timings::default(),
        };
        record.fingerprint = fingerprint(&record, recording);
        record
    }

    /// Scans that could not be labelled, with their sequence.
    pub fn not_labelled(&self) -> impl Iterator<Item = (&str, &NotLabelled)> {
        self.sequences
            .iter()
            .flat_map(|sequence| sequence.not_labelled.iter().map(|scan| (sequence.name.as_str(), scan)))
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

/// Equal where program, format, settings, sequences and inputs are.
fn fingerprint(record: &RunRecord, recording: &Recording) -> String {
    let mut hasher = blake3::Hasher::new();
    let mut add = |text: &str| {
        hasher.update(&(text.len() as u64).to_le_bytes());
        hasher.update(text.as_bytes());
    };
    add(&record.version);
    add(&record.format);
    // Debug shows every digit of every setting.
    add(&format!("{:?}", record.settings));
    recording.sequences.iter().for_each(|reader| add(&reader.sequence().name));
    record.inputs.iter().for_each(|input| {
        add(&input.file);
        add(&input.blake3);
    });
    hasher.finalize().to_hex()[..32].to_owned()
}

impl ImageRecord {
    pub(super) fn of(moment: &ImageMoment) -> Self {
        let views = moment.views.iter().map(|view| view.report).collect();
        Self { image: moment.image, views, problem: moment.problem.clone() }
    }
}

impl CameraRecord {
    /// Views, and how many of them have failed.
    pub fn views(&self) -> (usize, usize) {
        let all = self.images.iter().flat_map(|image| &image.views);
        let failed = all.clone().filter(|view| view.state != ViewState::Calibrated).count();
        (all.count(), failed)
    }
}

impl RadarRecord {
    /// Adds the next scan.
    pub(super) fn push(&mut self, table: &ScanTable) {
        self.detections.push(table.len() as u32);
        self.plausible.push(table.label.iter().map(|label| u32::from(*label)).sum());
        self.flags.push(table.flags.iter().fold(0, |all, flags| all | flags));
    }
}
