//! Which scans of a picture could not be labelled.

use crate::{Pictures, ReportError};
use ralf::sensors::Sequence;
use ralf_data::ScanIndex;
use ralf_data::result::{RadarScanKey, SequenceRecord};
use std::collections::BTreeSet;

impl Pictures<'_> {
    /// The scans that could not be labelled and the reasons, a sentence each, of a picture of what is around one scan,
    /// or of a whole sequence.
    ///
    /// # Errors
    /// No such radar or scan, and a picture without any labels: it would show that nothing is plausible.
    pub fn missing(&self, record: &SequenceRecord, scan: Option<usize>) -> Result<Vec<String>, ReportError> {
        let drawn = self.drawn(scan)?;
        let missing = record.not_labelled.iter();
        let missing =
            missing.filter(|missing| drawn.contains(&RadarScanKey::new(&missing.radar, missing.scan)));
        let missing: Vec<String> = missing.map(|missing| missing.told(&record.name)).collect();
        match missing.first() {
            Some(first) if missing.len() == drawn.len() => Err(ReportError::NotLabelled(first.clone())),
            _ => Ok(missing),
        }
    }

    /// The scans that a picture shows.
    fn drawn(&self, scan: Option<usize>) -> Result<BTreeSet<RadarScanKey>, ReportError> {
        let Sequence { rig, times, .. } = self.reader.sequence();
        let named = |at: ScanIndex| RadarScanKey::new(&rig.radars[at.radar].name, at.scan);
        if let Some(scan) = scan {
            return Ok(self.drawn_at(self.time_of(scan)?).map(named).collect());
        }
        let shown = (0..rig.radars.len()).filter(|radar| self.shows(&rig.radars[*radar].name));
        let scans =
            shown.flat_map(|radar| (0..times.radars[radar].len()).map(move |scan| ScanIndex { radar, scan }));
        Ok(scans.map(named).collect())
    }
}
