//! Labels without files: for whoever has the recording in memory and wants the labels there, too.

use super::workers::Labelling;
use super::{LabelRun, Observer};
use crate::error::DataError;
use crate::frames::{ScanIndex, all_scans};
use crate::result::{RadarScanKey, Table};

impl LabelRun<'_> {
    /// Labels the same scans, and hands out their tables: a list per sequence, in the recording's order, each radar by
    /// radar in the order of the rig. Nothing is written, and `out` is not looked at.
    ///
    /// # Errors
    /// Those of [`Self::execute`], but a scan that can't be labelled ends it.
    pub fn tables(&self, observer: &dyn Observer) -> Result<Vec<Vec<(RadarScanKey, Table)>>, DataError> {
        let labeler = self.labeler()?;
        let tasks = self.tasks(&labeler)?;
        let of_sequence = |task| {
            let labelling = Labelling { task, config: &self.settings.method, observer };
            labelling.each(&all_scans(&task.reader.sequence().times), self.jobs, |window, at| {
                let ScanIndex { radar, scan } = at;
                let sensor = task.rig.radars[radar].name.clone();
                let frame = window.frame(radar, scan);
                let frame = frame.map_err(|error| DataError::Measurement { sensor, index: scan, error })?;
                let table = labelling.table(radar, &frame)?;
                observer.advance(1, table.len() as u64);
                Ok((RadarScanKey::new(&task.rig.radars[radar].name, scan), table))
            })
        };
        tasks.iter().map(of_sequence).collect()
    }
}
