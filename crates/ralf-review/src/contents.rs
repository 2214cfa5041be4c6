//! What the recording's scans hold: corrections belong to a scan with its content, and to no other.

use ralf::sensors::SourceError;
use ralf_data::{HeldContent, ScanIndex, SequenceReader};
use std::collections::BTreeMap;
use std::sync::{Mutex, PoisonError};

/// A sequence, a radar and a scan by their places.
type Place = (usize, ScanIndex);

/// The contents of scans, as they were read last. What could not be read is tried again when it's asked for: a disk
/// over the network may have been away for a moment.
#[derive(Default)]
pub(crate) struct Contents(Mutex<BTreeMap<Place, HeldContent>>);

impl Contents {
    /// What a scan holds now.
    pub(crate) fn read(&self, reader: &dyn SequenceReader, place: Place) -> Result<HeldContent, SourceError> {
        let found = HeldContent::read(reader, place.1);
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match &found {
            Ok(held) => known.insert(place, *held),
            Err(_) => known.remove(&place),
        };
        found
    }

    /// What a scan holds as it was read last, for lists of many scans; read now if it never was. `None` of one that
    /// can't be read.
    pub(crate) fn known(&self, reader: &dyn SequenceReader, place: Place) -> Option<HeldContent> {
        let known = self.0.lock().unwrap_or_else(PoisonError::into_inner).get(&place).copied();
        known.or_else(|| self.read(reader, place).ok())
    }
}
