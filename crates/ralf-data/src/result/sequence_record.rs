//! What `run.json` tells of a sequence.

use super::label_hash::hash_of_labels;
use super::own_files::told_within;
use super::{RadarCounts, Table, UnlikeSisters, WithoutNumbers};
use crate::disk::label_file::label_bytes;
use crate::error::DataError;
use crate::read::MotionSource;
use ralf::label::flag;
use ralf::scene::{CalibratedImage, Frame, NotRead, SensorKind, Unreadable, ViewReport, ViewState};
use ralf::sensors::Rig;
use serde::{Deserialize, Serialize};
use std::path::Path;

/// One sequence.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SequenceRecord {
    /// Its name.
    pub name: String,
    /// Of program, settings, name and inputs together: equal where the results are equal.
    pub fingerprint: String,
    /// Where the recording lay, wherever the program was started. An older record doesn't tell.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub recording: String,
    /// Of `plausibility.parquet`. An older record has none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<FileRecord>,
    /// In the rig's order.
    pub radars: Vec<RadarRecord>,
    /// In the rig's order.
    pub cameras: Vec<CameraRecord>,
    /// Scans that could not be labelled.
    pub not_labelled: Vec<NotLabelled>,
    /// What of the recording can't be read and may have held scans that nothing else tells of, a sentence each.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub lost: Vec<String>,
    /// Radars whose plausible share is far from that of the others.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unlike_sisters: Vec<UnlikeSisters>,
    /// Radars whose places, or all values of a field, are no numbers.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub without_numbers: Vec<WithoutNumbers>,
    /// Where the vehicle's motion comes from, if not from the recording.
    #[serde(default, skip_serializing_if = "is_recorded")]
    pub motion: MotionSource,
    /// Scans and segmentations that can't be read: what lies near them in time was labelled without.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub unreadable: Vec<UnreadableScan>,
    /// All that labelling wanted and could not read, but for the scans that are not labelled: the next run asks for
    /// these again, and labels the sequence again where one of them is to be had.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub not_read: Vec<UnreadMeasurement>,
}

impl SequenceRecord {
    /// Radars whose labels are to be doubted, each for one of the reasons below: radar, what there is to say.
    pub fn doubtful_radars(&self) -> Vec<(&str, String)> {
        [self.radars_without_numbers(), self.radars_unlike_sisters(), self.radars_hardly_plausible()].concat()
    }

    /// Radars that have detections and no numbers.
    pub(super) fn radars_without_numbers(&self) -> Vec<(&str, String)> {
        self.without_numbers.iter().map(|found| (found.radar.as_str(), found.words())).collect()
    }

    /// Radars whose plausible share is far from that of the others.
    pub(super) fn radars_unlike_sisters(&self) -> Vec<(&str, String)> {
        self.unlike_sisters.iter().map(|found| (found.radar.as_str(), found.words())).collect()
    }

    /// Radars that have numbers and hardly any plausible detection, but for those that are told as unlike the others.
    pub(super) fn radars_hardly_plausible(&self) -> Vec<(&str, String)> {
        let is_told = |radar: &str| {
            let mut told = self.without_numbers.iter().map(|found| &found.radar);
            told.any(|name| name == radar) || self.unlike_sisters.iter().any(|found| found.radar == radar)
        };
        let radars = self.radars.iter().filter(|radar| !is_told(&radar.name));
        radars.filter_map(|radar| Some((radar.name.as_str(), radar.counts().hardly_any()?))).collect()
    }
}

fn is_recorded(motion: &MotionSource) -> bool {
    *motion == MotionSource::Recorded
}

/// A scan that can't be read.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct UnreadableScan {
    /// The sensor's name.
    pub sensor: String,
    /// Number of the scan.
    pub scan: usize,
    /// File, place, expected, found.
    pub reason: String,
}

impl From<Unreadable> for UnreadableScan {
    fn from(Unreadable { sensor, index, reason }: Unreadable) -> Self {
        Self { sensor, scan: index, reason }
    }
}

/// A measurement that could not be read, or what is stored of it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct UnreadMeasurement {
    /// What the sensor is.
    #[serde(with = "KindName")]
    pub kind: SensorKind,
    /// Which scan or image, and why.
    #[serde(flatten)]
    pub scan: UnreadableScan,
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "SensorKind", rename_all = "snake_case")]
enum KindName {
    Radar,
    Lidar,
    Camera,
}

impl UnreadMeasurement {
    /// What a frame tells, whose recording lies at `root`.
    fn of(NotRead { kind, sensor, index, reason }: &NotRead, rig: &Rig, root: &Path) -> Self {
        let sensor = match kind {
            SensorKind::Radar => &rig.radars[*sensor].name,
            SensorKind::Lidar => &rig.lidars[*sensor].name,
            SensorKind::Camera => &rig.cameras[*sensor].name,
        };
        let reason = told_within(reason, root);
        Self { kind: *kind, scan: UnreadableScan { sensor: sensor.clone(), scan: *index, reason } }
    }
}

/// What is told of a labelled scan beside its detections.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(crate) struct ScanNotes {
    /// Images that were asked, with the names of their cameras.
    pub(crate) images: Vec<(String, ImageRecord)>,
    /// LiDAR scans and segmentations that it had to do without.
    pub(crate) unreadable: Vec<UnreadableScan>,
    /// All that could not be read of it.
    #[serde(default)]
    pub(crate) not_read: Vec<UnreadMeasurement>,
}

impl ScanNotes {
    /// What a frame tells, whose recording lies at `root`.
    pub(crate) fn new(frame: &Frame, root: &Path) -> Self {
        let name = |moment: &CalibratedImage| frame.rig.cameras[moment.id.camera].name.clone();
        let images =
            frame.images.iter().map(|view| (name(&view.moment), ImageRecord::of(&view.moment, root)));
        let mut unreadable: Vec<_> = frame.unreadable.iter().cloned().map(UnreadableScan::from).collect();
        unreadable.iter_mut().for_each(|scan| scan.reason = told_within(&scan.reason, root));
        let not_read = frame.not_read.iter().map(|found| UnreadMeasurement::of(found, frame.rig, root));
        Self { images: images.collect(), unreadable, not_read: not_read.collect() }
    }
}

/// A file as it was written.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct FileRecord {
    /// Its size.
    pub bytes: u64,
    /// Of its content.
    pub blake3: String,
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
    /// The first 16 digits of the BLAKE3 of each scan's `.label` file; empty for a scan that has none. An older record
    /// has no list.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub labels: Vec<String>,
}

/// The images of one camera that were asked about a radar scan and have depth.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct CameraRecord {
    /// The camera's name.
    pub name: String,
    /// Views of all images.
    pub views: usize,
    /// How many of these have failed.
    pub failed: usize,
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

impl NotLabelled {
    /// Which scan of a sequence it is and why, for people.
    pub fn told(&self, sequence: &str) -> String {
        let Self { radar, scan, reason } = self;
        format!("{sequence} {radar} scan {scan}: {reason}")
    }
}

impl ImageRecord {
    fn of(moment: &CalibratedImage, root: &Path) -> Self {
        let views = moment.views.iter().map(|view| view.report).collect();
        let problem = moment.problem.as_ref().map(|problem| told_within(problem, root));
        Self { image: moment.id.image, views, problem }
    }
}

impl CameraRecord {
    /// The images of a camera, summed up.
    pub(crate) fn new(name: &str, images: Vec<ImageRecord>) -> Self {
        let views = images.iter().flat_map(|image| &image.views);
        let failed = views.clone().filter(|view| view.state != ViewState::Calibrated).count();
        Self { name: name.to_owned(), views: views.count(), failed, images }
    }
}

impl RadarRecord {
    /// Over all scans that had a LiDAR's beside them: what others are worth depends on how densely a radar sees.
    pub(crate) fn counts(&self) -> RadarCounts<'_> {
        let mut counts = RadarCounts { radar: &self.name, plausible: 0, detections: 0 };
        let rows = self.plausible.iter().zip(&self.detections).zip(&self.flags);
        for ((plausible, detections), _) in rows.filter(|(_, flags)| **flags & flag::NO_LIDAR == 0) {
            counts.plausible += u64::from(*plausible);
            counts.detections += u64::from(*detections);
        }
        counts
    }

    /// Whether these are the bytes that were written of a scan's labels. Of an older record this isn't known.
    pub(crate) fn labels_match(&self, scan: usize, bytes: &[u8]) -> bool {
        self.labels.get(scan).is_none_or(|written| written.is_empty() || *written == hash_of_labels(bytes))
    }

    /// Adds the scans that follow.
    pub(crate) fn append(&mut self, more: Self) {
        self.detections.extend(more.detections);
        self.plausible.extend(more.plausible);
        self.flags.extend(more.flags);
        self.labels.extend(more.labels);
    }

    /// Adds the next scan; one that could not be labelled has no table.
    ///
    /// # Errors
    /// A table that isn't of a labelled scan.
    pub(crate) fn push(&mut self, table: Option<&Table>) -> Result<(), DataError> {
        let Some(table) = table else {
            self.detections.push(0);
            self.plausible.push(0);
            self.flags.push(0);
            self.labels.push(String::new());
            return Ok(());
        };
        self.labels.push(hash_of_labels(&label_bytes(&table.labels()?)));
        self.detections.push(table.len() as u32);
        self.plausible.push(table.get::<u8>("label")?.iter().map(|label| u32::from(*label)).sum());
        self.flags.push(table.get::<u16>("flags")?.iter().fold(0, |all, flags| all | flags));
        Ok(())
    }
}
