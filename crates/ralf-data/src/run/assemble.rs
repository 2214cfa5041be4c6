//! Putting a sequence's labelled scans together, in the order of the rig.

use super::record::{CameraRecord, NotLabelled, RadarRecord, SequenceRecord};
use super::workspace::Workspace;
use super::{Observer, Stage, Task};
use crate::DataError;
use crate::output::{PlausibilityWriter, ScanTable, read_rows};
use ralf::camera::Camera;
use std::collections::BTreeSet;

/// Writes `plausibility.parquet` of a sequence from its scans' tables.
pub(super) fn assemble(
    task: &Task,
    workspace: &Workspace,
    not_labelled: Vec<NotLabelled>,
    observer: &dyn Observer,
) -> Result<SequenceRecord, DataError> {
    let sequence = task.reader.sequence();
    let missing: BTreeSet<_> = not_labelled.iter().map(|scan| (scan.radar.as_str(), scan.scan)).collect();
    let scans = sequence.times.radars.iter().map(Vec::len).sum::<usize>();
    observer.begin(Stage::Writing(&sequence.name), scans as u64);
    let mut writer = PlausibilityWriter::create(&workspace.plausibility_file(&sequence.name), &task.columns)?;
    let mut radars = Vec::with_capacity(task.rig.radars.len());
    for (radar, times) in task.rig.radars.iter().zip(&sequence.times.radars) {
        let mut record = RadarRecord { name: radar.name.clone(), ..RadarRecord::default() };
        for scan in 0..times.len() {
            let table = match missing.contains(&(radar.name.as_str(), scan)) {
                true => ScanTable::default(),
                false => read_rows(&workspace.rows_file(&sequence.name, &radar.name, scan), &task.columns)?,
            };
            writer.append(&radar.name, scan, &table)?;
            record.push(&table);
            observer.advance(1, table.len() as u64);
        }
        radars.push(record);
    }
    writer.finish()?;
    observer.end();
    let cameras = cameras(task, workspace)?;
    Ok(SequenceRecord { name: sequence.name.clone(), radars, cameras, not_labelled, seconds: 0.0 })
}

/// What the monitor found about the images that were asked.
fn cameras(task: &Task, workspace: &Workspace) -> Result<Vec<CameraRecord>, DataError> {
    let sequence = task.reader.sequence();
    let record = |(camera, times): (&Camera, &Vec<i64>)| {
        let images = (0..times.len())
            .filter_map(|image| workspace.image(&sequence.name, &camera.name, image).transpose());
        Ok(CameraRecord { name: camera.name.clone(), images: images.collect::<Result<_, DataError>>()? })
    };
    task.rig.cameras.iter().zip(&sequence.times.cameras).map(record).collect()
}
