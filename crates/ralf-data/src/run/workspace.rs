//! A sequence while it is labelled: its scans, each in files of its own, that a run which was killed finds again.
//!
//! `FINGERPRINT/SEQUENCE/RADAR/000000.rows` holds a labelled scan, `000000.json` what is told of it beside that.

use super::results::Results;
use crate::disk::label_file::write_labels;
use crate::error::DataError;
use crate::result::json::{read_json, write_json};
use crate::result::{Component, OutFolder, ScanNotes, Schema, SequenceNames, Table, read_rows, write_rows};
use std::fs;
use std::path::PathBuf;
use std::sync::Arc;

/// The scans of a sequence.
pub(super) struct Workspace<'a> {
    names: &'a SequenceNames,
    folder: OutFolder,
    results: &'a Results,
}

impl<'a> Workspace<'a> {
    /// The scans that are kept in this folder.
    pub(super) fn new(names: &'a SequenceNames, folder: OutFolder, results: &'a Results) -> Self {
        Self { names, folder, results }
    }

    /// Where the sequence's table goes.
    pub(super) fn plausibility_file(&self) -> PathBuf {
        self.results.places().plausibility_file(&self.names.sequence)
    }

    /// Keeps a labelled scan. Its `.label` file comes last, so that no label is without a table that tells of it.
    pub(super) fn keep(
        &self,
        radar: usize,
        scan: usize,
        notes: &ScanNotes,
        table: &Table,
    ) -> Result<(), DataError> {
        write_rows(&self.file(radar, scan, "rows"), table)?;
        write_json(&self.file(radar, scan, "json"), notes)?;
        write_labels(&self.label_file(radar, scan), &table.labels()?)
    }

    /// Whether a scan was labelled before, and all its files are whole: a power cut may leave empty ones.
    pub(super) fn has_kept(&self, radar: usize, scan: usize, schema: &Arc<Schema>) -> bool {
        let label = fs::metadata(self.label_file(radar, scan));
        let Ok(table) = self.table(radar, scan, schema) else { return false };
        label.is_ok_and(|label| label.len() == 4 * table.len() as u64) && self.notes(radar, scan).is_ok()
    }

    /// The table of a scan.
    pub(super) fn table(&self, radar: usize, scan: usize, schema: &Arc<Schema>) -> Result<Table, DataError> {
        read_rows(&self.file(radar, scan, "rows"), schema)
    }

    /// What is told of a scan beside its detections.
    pub(super) fn notes(&self, radar: usize, scan: usize) -> Result<ScanNotes, DataError> {
        read_json(&self.file(radar, scan, "json"))
    }

    /// Removes the `.label` file that an earlier run made of a scan that can't be labelled now.
    pub(super) fn forget(&self, radar: usize, scan: usize) -> Result<(), DataError> {
        self.results.remove_label(&self.names.sequence, &self.names.radars[radar], scan)
    }

    /// The labels of a scan.
    pub(super) fn label_file(&self, radar: usize, scan: usize) -> PathBuf {
        self.results.places().label_file(&self.names.sequence, &self.names.radars[radar], scan)
    }

    fn file(&self, radar: usize, scan: usize, kind: &'static str) -> PathBuf {
        self.folder.folder(&self.names.radars[radar]).file(&Component::numbered(scan, kind))
    }
}
