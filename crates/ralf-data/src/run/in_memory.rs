//! Labels without files: for whoever has the recording in memory and wants the labels there, too.

use super::told::Told;
use super::workers::Labelling;
use super::{LabelRun, Observer, Task};
use crate::error::DataError;
use crate::frames::{ScanIndex, all_scans};
use crate::result::{RadarScanKey, ScanNotes, SequenceRecord, Table};

/// A sequence that was labelled without files.
#[derive(Debug)]
pub struct InMemory {
    /// The tables of its scans, radar by radar in the order of the rig.
    pub scans: Vec<(RadarScanKey, Table)>,
    /// What is told of it, as of one that was written; nothing knows it again, and it has no table.
    pub record: SequenceRecord,
}

impl LabelRun<'_> {
    /// Labels the same scans, and hands out their tables, a sequence after the other in the recording's order. Nothing
    /// is written, and `out` is not looked at.
    ///
    /// # Errors
    /// Those of [`Self::execute`], but a scan that can't be labelled ends it.
    pub fn in_memory(&self, observer: &dyn Observer) -> Result<Vec<InMemory>, DataError> {
        let labeler = self.labeler()?;
        let tasks = self.tasks(&labeler)?;
        tasks.iter().map(|task| self.label_in_memory(task, observer)).collect()
    }

    fn label_in_memory(&self, task: &Task, observer: &dyn Observer) -> Result<InMemory, DataError> {
        let labelling = Labelling { task, config: &self.settings.method, observer };
        let labelled = labelling.each(&all_scans(task.times()), self.jobs, |window, at| {
            let ScanIndex { radar, scan } = at;
            let sensor = task.rig.radars[radar].name.clone();
            let frame = window.frame(radar, scan);
            let frame = frame.map_err(|error| DataError::Measurement { sensor, index: scan, error })?;
            let table = labelling.table(radar, &frame)?;
            observer.advance(1, table.len() as u64);
            let key = RadarScanKey::new(&task.rig.radars[radar].name, scan);
            Ok(((key, table), ScanNotes::new(&frame, task.root)))
        })?;
        let (mut scans, mut told) = (Vec::with_capacity(labelled.len()), Told::of(task));
        for (index, (scan, notes)) in all_scans(task.times()).iter().zip(labelled) {
            told.add(task, index.radar, Some((&scan.1, notes)))?;
            scans.push(scan);
        }
        let record = told.record(task, None, Vec::new(), "");
        Ok(InMemory { scans, record })
    }
}
