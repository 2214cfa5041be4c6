//! What the recording's scans hold: corrections belong to a scan with its content, and to no other.

use ralf::sensors::SourceError;
use ralf_corrections::{ScanContent, ScanSummary};
use ralf_data::{ScanIndex, SequenceReader, scan_content};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A sequence, a radar and a scan by their places.
type Place = (usize, ScanIndex);

/// The contents of scans, as they were read last; `None` of those that can't be read.
#[derive(Default)]
pub(crate) struct Contents(Mutex<BTreeMap<Place, Option<ScanContent>>>);

impl Contents {
    /// What a scan holds now.
    pub(crate) fn read(&self, reader: &dyn SequenceReader, place: Place) -> Result<ScanContent, SourceError> {
        let (_, ScanIndex { radar, scan }) = place;
        let found = reader.radar_scan(radar, scan).map(|scan| {
            // A file of more detections than fit is refused when it is read.
            let detections = u32::try_from(scan.len()).unwrap_or(u32::MAX);
            ScanContent { detections, hash: Some(scan_content(&scan)) }
        });
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.insert(place, found.as_ref().ok().copied());
        found
    }

    /// What a scan holds as it was read last, for lists of many scans; read now if it never was. `None` of one that
    /// can't be read.
    pub(crate) fn known(&self, reader: &dyn SequenceReader, place: Place) -> Option<ScanContent> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner).get(&place).copied();
        known.unwrap_or_else(|| self.read(reader, place).ok())
    }

    /// Whether something was said of what the scan holds, and not of something else. `place` is `None` where
    /// the recording has no such scan.
    pub(crate) fn holds(
        &self,
        reader: &dyn SequenceReader,
        place: Option<Place>,
        said: &ScanSummary,
    ) -> bool {
        let content = place.and_then(|place| self.known(reader, place));
        content.is_some_and(|content| content.find_in(&[said.content]).is_some())
    }
}
