//! Where a run's results lie, and how they go once others take their places.

use super::sequence_record::SequenceRecord;
use crate::disk::files;
use crate::error::DataError;
use crate::read::layout::is_folder_name;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder `OUT/sequences`.
#[derive(Debug)]
pub(super) struct Results {
    sequences: PathBuf,
}

impl Results {
    /// The results in an output folder.
    pub(super) fn of(out: &Path) -> Self {
        Self { sequences: out.join("sequences") }
    }

    /// The table of a sequence.
    pub(super) fn plausibility_file(&self, sequence: &str) -> PathBuf {
        self.sequences.join(sequence).join("plausibility.parquet")
    }

    /// The labels of a scan.
    pub(super) fn label_file(&self, sequence: &str, radar: &str, scan: usize) -> PathBuf {
        self.sequences.join(sequence).join(radar).join(format!("{scan:06}.label"))
    }

    /// Whether every result that a record tells of is there.
    pub(super) fn hold(&self, record: &SequenceRecord) -> bool {
        let not_labelled: BTreeSet<_> =
            record.not_labelled.iter().map(|scan| (scan.radar.as_str(), scan.scan)).collect();
        let labelled = scans(record).filter(|scan| !not_labelled.contains(scan));
        let mut labels = labelled.map(|(radar, scan)| self.label_file(&record.name, radar, scan));
        self.plausibility_file(&record.name).is_file() && labels.all(|file| file.is_file())
    }

    /// Removes the results that a record tells of, and nothing else that people may have put beside them.
    pub(super) fn remove(&self, record: &SequenceRecord) -> Result<(), DataError> {
        for (radar, scan) in scans(record) {
            self.remove_label(&record.name, radar, scan)?;
        }
        self.remove_folders(&record.name, record.radars.iter().map(|radar| radar.name.as_str()))
    }

    /// Removes what was labelled of sequences, by the scans that are kept as `SEQUENCE/RADAR/000000.rows`.
    pub(super) fn remove_unfinished(&self, kept: &Path) -> Result<(), DataError> {
        for sequence in files::folders(kept)? {
            let radars = files::folders(&kept.join(&sequence))?;
            for radar in &radars {
                let names = files::names(&kept.join(&sequence).join(radar))?;
                for scan in names.iter().filter_map(|name| name.strip_suffix(".rows")?.parse().ok()) {
                    self.remove_label(&sequence, radar, scan)?;
                }
            }
            self.remove_folders(&sequence, radars.iter().map(String::as_str))?;
        }
        Ok(())
    }

    /// Removes a scan's labels, if there are some.
    pub(super) fn remove_label(&self, sequence: &str, radar: &str, scan: usize) -> Result<(), DataError> {
        // A record that somebody has edited leads nowhere else.
        if !is_folder_name(sequence) || !is_folder_name(radar) {
            return Ok(());
        }
        files::remove(&self.label_file(sequence, radar, scan))
    }

    /// Removes the table, and the folders that are empty now.
    fn remove_folders<'a>(
        &self,
        sequence: &str,
        radars: impl Iterator<Item = &'a str>,
    ) -> Result<(), DataError> {
        if !is_folder_name(sequence) {
            return Ok(());
        }
        files::remove(&self.plausibility_file(sequence))?;
        let folder = self.sequences.join(sequence);
        // A folder that still holds something stays: that is no failure.
        for radar in radars.filter(|radar| is_folder_name(radar)) {
            let _ = fs::remove_dir(folder.join(radar));
        }
        let _ = fs::remove_dir(folder);
        Ok(())
    }
}

/// All scans that a record tells of: radar, number.
fn scans(record: &SequenceRecord) -> impl Iterator<Item = (&str, usize)> {
    record.radars.iter().flat_map(|radar| (0..radar.detections.len()).map(|scan| (radar.name.as_str(), scan)))
}
