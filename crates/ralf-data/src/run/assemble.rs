//! Putting a sequence's labelled scans together, in the order of the rig.

use super::workspace::Workspace;
use super::{Observer, Stage, Task};
use crate::error::DataError;
use crate::result::{
    CameraRecord, ImageRecord, NotLabelled, PlausibilityWriter, RadarRecord, RadarScanKey, SequenceRecord,
    UnlikeSisters,
};
use ralf::sensors::Camera;
use std::collections::{BTreeMap, BTreeSet};

/// Images by camera and number; several scans may have asked about one.
type Images = BTreeMap<String, BTreeMap<usize, ImageRecord>>;

/// Writes `plausibility.parquet` of a sequence from its scans' tables.
pub(super) fn assemble(
    task: &Task,
    fingerprint: &str,
    workspace: &Workspace,
    not_labelled: Vec<NotLabelled>,
    observer: &dyn Observer,
) -> Result<SequenceRecord, DataError> {
    let sequence = task.reader.sequence();
    let missing: BTreeSet<_> = not_labelled.iter().map(|scan| (scan.radar.as_str(), scan.scan)).collect();
    observer.begin(Stage::Writing(&sequence.name), task.scans() as u64);
    let mut writer = PlausibilityWriter::create(&workspace.plausibility_file(), &task.schema)?;
    let mut radars = Vec::with_capacity(task.rig.radars.len());
    let mut images = Images::new();
    let mut unreadable = BTreeSet::new();
    for (index, (radar, times)) in task.rig.radars.iter().zip(&sequence.times.radars).enumerate() {
        let mut record = RadarRecord { name: radar.name.clone(), ..RadarRecord::default() };
        for scan in 0..times.len() {
            if missing.contains(&(radar.name.as_str(), scan)) {
                record.push(None)?;
                observer.advance(1, 0);
                continue;
            }
            if observer.stopped() {
                return Err(DataError::Stopped);
            }
            let (table, notes) = workspace.scan(index, scan, &task.schema)?;
            unreadable.extend(notes.unreadable);
            for (camera, image) in notes.images {
                images.entry(camera).or_default().insert(image.image, image);
            }
            writer.append(&RadarScanKey::new(&radar.name, scan), &table)?;
            record.push(Some(&table))?;
            observer.advance(1, table.len() as u64);
        }
        radars.push(record);
    }
    let table = Some(writer.finish()?);
    observer.end();
    let cameras = cameras(&task.rig.cameras, images);
    let fingerprint = fingerprint.to_owned();
    Ok(SequenceRecord {
        name: sequence.name.clone(),
        fingerprint,
        table,
        unlike_sisters: UnlikeSisters::of(&radars.iter().map(RadarRecord::counts).collect::<Vec<_>>()),
        radars,
        cameras,
        not_labelled,
        motion: task.reader.motion_source(),
        unreadable: unreadable.into_iter().collect(),
    })
}

/// What the monitor found about the images that were asked.
fn cameras(rig: &[Camera], mut images: Images) -> Vec<CameraRecord> {
    let record = |camera: &Camera| {
        let images = images.remove(&camera.name).unwrap_or_default();
        CameraRecord::new(&camera.name, images.into_values().collect())
    };
    rig.iter().map(record).collect()
}
