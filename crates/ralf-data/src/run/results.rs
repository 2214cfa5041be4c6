//! How a run's results go once others take their places.

use super::scan_log::scans_in;
use crate::disk::files;
use crate::error::DataError;
use crate::result::{Component, Places, SequenceRecord};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The results in an output folder.
#[derive(Debug)]
pub(super) struct Results {
    places: Places,
}

impl Results {
    pub(super) fn new(out: &Path) -> Self {
        Self { places: Places::new(out) }
    }

    /// Where they lie.
    pub(super) fn places(&self) -> &Places {
        &self.places
    }

    /// Removes the results that a record tells of, and nothing else that people may have put beside them.
    pub(super) fn remove(&self, record: &SequenceRecord) -> Result<(), DataError> {
        // A record that somebody has edited leads nowhere else: such names are passed over.
        let Ok(sequence) = Component::new(&record.name) else { return Ok(()) };
        let mut radars = Vec::new();
        for radar in &record.radars {
            let Ok(folder) = Component::new(&radar.name) else { continue };
            for scan in 0..radar.detections.len() {
                files::remove(&self.places.label_file(&sequence, &folder, scan))?;
            }
            radars.push(folder);
        }
        self.remove_folders(&sequence, &radars)
    }

    /// Removes what was labelled of the sequences that are under way in a folder. Returns their names, of those that
    /// had labels.
    pub(super) fn remove_unfinished(&self, kept: &Path) -> Result<Vec<String>, DataError> {
        let mut removed = Vec::new();
        for sequence in components(kept)? {
            let mut radars = BTreeSet::new();
            for (radar, scan) in scans_in(&kept.join(sequence.as_str()))? {
                self.remove_label(&sequence, &radar, scan)?;
                radars.insert(radar);
            }
            if !radars.is_empty() {
                removed.push(sequence.as_str().to_owned());
            }
            self.remove_folders(&sequence, &Vec::from_iter(radars))?;
        }
        Ok(removed)
    }

    /// Removes a scan's labels, if there are some.
    pub(super) fn remove_label(
        &self,
        sequence: &Component,
        radar: &Component,
        scan: usize,
    ) -> Result<(), DataError> {
        files::remove(&self.places.label_file(sequence, radar, scan))
    }

    /// Removes the table, and the folders that are empty now.
    fn remove_folders(&self, sequence: &Component, radars: &[Component]) -> Result<(), DataError> {
        files::remove(&self.places.plausibility_file(sequence))?;
        let folder = self.places.folder(sequence);
        // A folder that still holds something stays: that is no failure.
        for radar in radars {
            let _ = fs::remove_dir(folder.folder(radar).path());
        }
        let _ = fs::remove_dir(folder.path());
        Ok(())
    }
}

/// The folders in a folder whose names lead nowhere else.
fn components(folder: &Path) -> Result<Vec<Component>, DataError> {
    Ok(files::folders(folder)?.iter().filter_map(|name| Component::new(name).ok()).collect())
}
