//! Labels without files: for whoever has the recording in memory and wants the labels there, too.

use super::without::Without;
use super::workers::Labelling;
use super::{CameraRecord, LabelRun, Observer, Task, UnreadableScan};
use crate::error::DataError;
use crate::frames::{ScanIndex, all_scans};
use crate::result::{RadarScanKey, ScanNotes, Table};
use std::collections::BTreeSet;

/// A sequence that was labelled without files.
#[derive(Debug)]
pub struct InMemory {
    /// The tables of its scans, radar by radar in the order of the rig.
    pub scans: Vec<(RadarScanKey, Table)>,
    /// What they were labelled without, for it can't be read.
    pub unreadable: Vec<UnreadableScan>,
    /// The images that were asked, in the rig's order.
    pub cameras: Vec<CameraRecord>,
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
        let mut without = Without::default();
        let notes = |(scan, notes)| {
            without.add(notes);
            scan
        };
        let scans = labelled.into_iter().map(notes).collect();
        let (unreadable, _) = without.named(&BTreeSet::new());
        Ok(InMemory { scans, unreadable, cameras: without.cameras(&task.rig.cameras) })
    }
}
