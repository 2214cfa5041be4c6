//! What a run says of a sequence.

use crate::cache::Cache;
use crate::http::ApiError;
use crate::need::{Certainty, Doubts, ScanNeed};
use ralf::config::{Config, nanoseconds};
use ralf::learned::Model;
use ralf::scene::ViewState;
use ralf::sensors::{Rig, Sequence};
use ralf::space::sync;
use ralf_data::result::{
    CameraRecord, Component, ImageRecord, LabelledRun, LabelledSequence, Places, PlausibilityReader,
    RadarScanKey, Table,
};
use ralf_data::things::{Extent, SequenceEvidence, SequenceThings};
use ralf_data::{DataError, ScanIndex, SequenceReader};
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{SystemTime, UNIX_EPOCH};

/// Row groups that are kept: some 15 MB each, and several radars may be looked at together.
const GROUPS_KEPT: usize = 12;

/// At most so much of a sequence is learned from at once: some minutes of one processor, and 200 MB.
const MOST_SCANS: usize = 2000;
const MOST_DETECTIONS: usize = 200_000;

/// The labels of one sequence, and the settings that they were made with.
pub(crate) struct SequenceLabels {
    pub(crate) stamp: Stamp,
    /// With the settings' overrides.
    pub(crate) rig: Rig,
    pub(crate) settings: Config,
    pub(crate) reader: PlausibilityReader,
    groups: Cache<usize, BTreeMap<RadarScanKey, Table>>,
    /// By camera of the rig: images that were asked, and whether one of their views has failed.
    images: Vec<BTreeMap<usize, bool>>,
    /// Why scans could not be labelled, by radar and number.
    not_labelled: BTreeMap<RadarScanKey, String>,
    needs: Cache<(), Vec<ScanNeed>>,
    things: Cache<(), SequenceThings>,
    observed: Cache<(), SequenceEvidence>,
}

/// What changes when a sequence is labelled again: sizes and times of the files.
pub(crate) type Stamp = Vec<(PathBuf, u64, SystemTime)>;

impl SequenceLabels {
    /// Of the labels that lie there now; 404 where there are none.
    pub(crate) fn stamp(out: &Path, sequence: &str) -> Result<Stamp, ApiError> {
        let stamp = |file: PathBuf| {
            let meta = fs::metadata(&file).map_err(|error| match error.kind() {
                std::io::ErrorKind::NotFound => {
                    let file = file.display();
                    ApiError::Unknown(format!(
                        "{file}: expected a result of `ralf label`, found no such file"
                    ))
                }
                _ => DataError::io(&file)(error).into(),
            })?;
            let time = meta.modified().map_err(DataError::io(&file))?;
            Ok((file, meta.len(), time))
        };
        files(out, sequence)?.map(stamp).into_iter().collect()
    }

    pub(crate) fn is_of(&self, stamp: &Stamp) -> bool {
        self.stamp == *stamp
    }

    /// Names the run that these labels are of: another one once the sequence is labelled again.
    pub(crate) fn run(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        for (_, length, time) in &self.stamp {
            let since = time.duration_since(UNIX_EPOCH).unwrap_or_default();
            hasher.update(&length.to_le_bytes()).update(&since.as_nanos().to_le_bytes());
        }
        hasher.finalize().to_hex()[..32].to_owned()
    }

    pub(crate) fn load(out: &Path, reader: &dyn SequenceReader, stamp: Stamp) -> Result<Self, ApiError> {
        let LabelledSequence { record, rig, settings, tables } = LabelledRun::open(out)?.sequence(reader)?;
        let not_labelled = record.not_labelled.iter();
        let not_labelled = not_labelled
            .map(|scan| (RadarScanKey::new(&scan.radar, scan.scan), scan.reason.clone()))
            .collect();
        let images = rig.cameras.iter().map(|camera| asked_images(&record.cameras, &camera.name)).collect();
        Ok(Self {
            stamp,
            settings,
            reader: tables,
            groups: Cache::new(GROUPS_KEPT),
            images,
            not_labelled,
            needs: Cache::new(1),
            things: Cache::new(1),
            observed: Cache::new(1),
            rig,
        })
    }

    /// The labelled detections of a scan; 404 of one that could not be labelled.
    pub(crate) fn table(&self, radar: &str, scan: usize) -> Result<Table, ApiError> {
        if let Some(reason) = self.reason(radar, scan) {
            return Err(ApiError::Unknown(format!(
                "{radar} scan {scan}: expected labels, found none: {reason}"
            )));
        }
        let key = RadarScanKey::new(radar, scan);
        let nothing = || Table::empty(self.reader.schema().clone());
        let Some(group) = self.reader.group_of(&key) else { return Ok(nothing()) };
        let read = || Ok::<_, DataError>(self.reader.tables(group)?.into_iter().collect());
        let tables = self.groups.get(group, |_| true, read)?;
        Ok(tables.get(&key).cloned().unwrap_or_else(nothing))
    }

    /// Why a scan could not be labelled.
    pub(crate) fn reason(&self, radar: &str, scan: usize) -> Option<&str> {
        self.not_labelled.get(&RadarScanKey::new(radar, scan)).map(String::as_str)
    }

    /// The cameras (by their place in the rig) whose image nearest to a time was asked, and of which a view has failed.
    pub(crate) fn failed_cameras_at(&self, times: &[Vec<i64>], t_ns: i64) -> BTreeSet<usize> {
        let tolerance = nanoseconds(self.settings.sync.camera_tolerance_ms);
        let cameras = times.iter().zip(&self.images).enumerate();
        let failed = cameras.filter(|(_, (times, images))| {
            let image = sync::nearest(times, t_ns, tolerance);
            image.is_some_and(|image| images.get(&image) == Some(&true))
        });
        failed.map(|(camera, _)| camera).collect()
    }

    /// What belongs together in the sequence; found out once.
    pub(crate) fn things(&self, reader: &dyn SequenceReader) -> Result<Arc<SequenceThings>, ApiError> {
        let certainty = Certainty::of(&self.settings);
        let find = || SequenceThings::of(reader, &self.rig, &certainty, &self.reader);
        Ok(self.things.get((), |_| true, find)?)
    }

    /// All evidence on these things around a time, as far as [`MOST_SCANS`] and [`MOST_DETECTIONS`] let; gathered once,
    /// by so many threads, and again where somebody looks at another part of a long sequence.
    pub(crate) fn observed(
        &self,
        reader: &dyn SequenceReader,
        things: &SequenceThings,
        t_ns: i64,
        jobs: usize,
    ) -> Result<Arc<SequenceEvidence>, ApiError> {
        let extent = Extent { t_ns, scans: MOST_SCANS, detections: MOST_DETECTIONS };
        let gather = || {
            let model = Model::shipped().map_err(|error| ApiError::Broken(error.to_string()))?;
            SequenceEvidence::of(reader, &self.rig, &self.settings, &model, things, extent, jobs)
                .map_err(|error| ApiError::Broken(error.to_string()))
        };
        self.observed.get((), |observed| observed.serves(t_ns), gather)
    }

    /// How much each scan needs a person, in the order of the rig.
    pub(crate) fn needs(&self, reader: &dyn SequenceReader) -> Result<Arc<Vec<ScanNeed>>, ApiError> {
        self.needs.get((), |_| true, || self.count_needs(reader.sequence()))
    }

    fn count_needs(&self, sequence: &Sequence) -> Result<Vec<ScanNeed>, ApiError> {
        let mut doubts = self.doubts()?;
        let mut needs = Vec::new();
        for (radar, times) in sequence.times.radars.iter().enumerate() {
            for (scan, t_ns) in times.iter().copied().enumerate() {
                let key = RadarScanKey::new(&sequence.rig.radars[radar].name, scan);
                if self.not_labelled.contains_key(&key) {
                    continue;
                }
                let doubts = doubts.remove(&key).unwrap_or_default();
                let cameras_failed = self.failed_cameras_at(&sequence.times.cameras, t_ns).len();
                let scan = ScanIndex { radar, scan };
                needs.push(ScanNeed { scan, t_ns, doubts, cameras_failed });
            }
        }
        Ok(needs)
    }

    /// The doubts of every scan that has detections; no more than one row group is in memory.
    fn doubts(&self) -> Result<BTreeMap<RadarScanKey, Doubts>, DataError> {
        let certainty = Certainty::of(&self.settings);
        let mut doubts = BTreeMap::new();
        self.reader.each(&Doubts::COLUMNS, |key, table| {
            doubts.insert(key.clone(), Doubts::of(table, &certainty)?);
            Ok::<_, DataError>(())
        })?;
        Ok(doubts)
    }
}

/// Where the labels of a sequence lie, and the record of their run.
fn files(out: &Path, sequence: &str) -> Result<[PathBuf; 2], ApiError> {
    let refused = |found| ApiError::unknown("sequence", found, "a name that a folder can have");
    let (places, sequence) = (Places::new(out), Component::new(sequence).map_err(refused)?);
    Ok([places.plausibility_file(&sequence), places.record_file()])
}

/// Whether a sequence is labelled.
pub(crate) fn is_labelled(out: &Path, sequence: &str) -> bool {
    files(out, sequence).is_ok_and(|[labels, _]| labels.is_file())
}

fn asked_images(cameras: &[CameraRecord], name: &str) -> BTreeMap<usize, bool> {
    let has_failed = |image: &ImageRecord| {
        image.problem.is_some() || image.views.iter().any(|view| view.state != ViewState::Calibrated)
    };
    let images = cameras.iter().filter(|camera| camera.name == name).flat_map(|camera| &camera.images);
    images.map(|image| (image.image, has_failed(image))).collect()
}
