//! What the recording's scans hold: corrections belong to a scan with its content, and to no other.

use ralf::sensors::SourceError;
use ralf_data::{HeldContent, ScanIndex, SequenceReader};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A sequence, a radar and a scan by their places.
type Place = (usize, ScanIndex);

/// The contents of scans, as they were read last; `None` of those that can't be read.
#[derive(Default)]
pub(crate) struct Contents(Mutex<BTreeMap<Place, Option<HeldContent>>>);

impl Contents {
    /// What a scan holds now.
    pub(crate) fn read(&self, reader: &dyn SequenceReader, place: Place) -> Result<HeldContent, SourceError> {
        let found = HeldContent::read(reader, place.1);
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        known.insert(place, found.as_ref().ok().copied());
        found
    }

    /// What a scan holds as it was read last, for lists of many scans; read now if it never was. `None` of one that
    /// can't be read.
    pub(crate) fn known(&self, reader: &dyn SequenceReader, place: Place) -> Option<HeldContent> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner).get(&place).copied();
        known.unwrap_or_else(|| self.read(reader, place).ok())
    }
}
