//! A sequence while it is labelled: its scans, which a run that was killed finds again.

use super::results::Results;
use super::scan_log::ScanLog;
use crate::disk::files;
use crate::disk::label_file::{label_bytes, write_labels};
use crate::error::DataError;
use crate::frames::ScanIndex;
use crate::result::{OutFolder, ScanNotes, Schema, SequenceNames, Table, row_bytes, table_of_rows};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The scans of a sequence.
pub(super) struct Workspace<'a> {
    names: &'a SequenceNames,
    log: ScanLog,
    results: &'a Results,
}

impl<'a> Workspace<'a> {
    /// The scans that are kept in this folder.
    pub(super) fn open(
        names: &'a SequenceNames,
        folder: OutFolder,
        results: &'a Results,
    ) -> Result<Self, DataError> {
        Ok(Self { names, log: ScanLog::open(folder, &names.radars)?, results })
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
        let file = self.label_file(radar, scan);
        let notes = serde_json::to_vec(notes).map_err(|error| DataError::io(&file)(error.into()))?;
        let body = [&(notes.len() as u64).to_le_bytes()[..], &notes, &row_bytes(&file, table)?].concat();
        self.log.append(ScanIndex { radar, scan }, table.len(), &body)?;
        write_labels(&file, &table.labels()?)
    }

    /// What is told of a scan that was labelled before; `None` where it was not, or not all of it is as it was written:
    /// a power cut may leave empty files. By its number of rows, which counts here, too, memory is asked for later.
    pub(super) fn kept(&self, radar: usize, scan: usize, schema: &Arc<Schema>) -> Option<ScanNotes> {
        let (table, notes) = self.scan(radar, scan, schema).ok()?;
        if table.len() != self.rows(ScanIndex { radar, scan }) {
            return None;
        }
        let labels = label_bytes(&table.labels().ok()?);
        let file = self.label_file(radar, scan);
        // What is of another length is not looked into.
        let is_long = fs::metadata(&file).is_ok_and(|found| found.len() == labels.len() as u64);
        (is_long && files::read(&file).is_ok_and(|found| found == labels)).then_some(notes)
    }

    /// Whether a scan was labelled before; whether that is whole is not looked at.
    pub(super) fn holds(&self, scan: ScanIndex) -> bool {
        self.log.rows(scan).is_some()
    }

    /// How many detections a scan has that was labelled.
    pub(super) fn rows(&self, scan: ScanIndex) -> usize {
        self.log.rows(scan).unwrap_or_default()
    }

    /// The table of a scan, and what is told of it beside its detections.
    pub(super) fn scan(
        &self,
        radar: usize,
        scan: usize,
        schema: &Arc<Schema>,
    ) -> Result<(Table, ScanNotes), DataError> {
        let (file, notes, rows) = self.parts(radar, scan)?;
        Ok((table_of_rows(&file, &rows, schema)?, notes))
    }

    /// The file in which a scan lies, what is told of it, and the bytes of its rows.
    fn parts(&self, radar: usize, scan: usize) -> Result<(Arc<Path>, ScanNotes, Vec<u8>), DataError> {
        let place = || format!("scan {scan} of {}", self.names.radars[radar].as_str());
        let lost =
            || DataError::content(self.log.folder(), place(), "what was labelled", "nothing that is whole");
        let (file, mut body) = self.log.read(ScanIndex { radar, scan }).ok_or_else(lost)?;
        let (notes, rest) = body.split_first_chunk().ok_or_else(lost)?;
        let length = usize::try_from(u64::from_le_bytes(*notes)).map_err(|_| lost())?;
        let (notes, rows) = rest.split_at_checked(length).ok_or_else(lost)?;
        let notes = serde_json::from_slice(notes).map_err(|_| lost())?;
        let before = body.len() - rows.len();
        body.drain(..before);
        Ok((file, notes, body))
    }

    /// What is told of a scan beside its detections; nothing of one that is not kept.
    pub(super) fn notes(&self, ScanIndex { radar, scan }: ScanIndex) -> Option<ScanNotes> {
        self.parts(radar, scan).ok().map(|(_, notes, _)| notes)
    }

    /// Removes the `.label` file that an earlier run made of a scan that can't be labelled now.
    pub(super) fn forget(&self, radar: usize, scan: usize) -> Result<(), DataError> {
        self.results.remove_label(&self.names.sequence, &self.names.radars[radar], scan)
    }

    /// The labels of a scan.
    pub(super) fn label_file(&self, radar: usize, scan: usize) -> PathBuf {
        self.results.places().label_file(&self.names.sequence, &self.names.radars[radar], scan)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read::models::ZF_FRGEN21;
    use crate::result::{Kind, Values};
    use ralf::sensors::{MemorySource, Rig, Source};
    use ralf::space::{EgoMotion, Transform};

    #[test]
    fn a_scan_that_claims_other_rows_than_it_has_is_labelled_again() {
        let out = tempfile::tempdir().unwrap();
        let radar = ZF_FRGEN21.mounted("front", &["x", "y", "z"], Transform::identity());
        let source = MemorySource::new("00", EgoMotion::unknown()).unwrap();
        let source = source.with_radar(radar, vec![(0, vec![vec![1.0]; 3])]).unwrap();
        let names = SequenceNames::new(source.sequence()).unwrap();
        let (results, folder) = (Results::new(out.path()), OutFolder::new(out.path()).own("kept"));
        let workspace = Workspace::open(&names, folder, &results).unwrap();
        let schema: Arc<Schema> = Schema::of(&Rig::default(), &[]).unwrap().into();
        let value = |kind| match kind {
            Kind::I64 => Values::I64(vec![0]),
            Kind::F32 => Values::F32(vec![0.0]),
            Kind::U8 => Values::U8(vec![1]),
            Kind::U16 => Values::U16(vec![0]),
            Kind::Class => Values::Class(vec![None]),
            _ => Values::U32(vec![0]),
        };
        let values = schema.columns().iter().map(|column| value(column.kind)).collect();
        let table = Table::new(schema.clone(), values).unwrap();
        workspace.keep(0, 0, &ScanNotes::default(), &table).unwrap();
        assert!(workspace.kept(0, 0, &schema).is_some());
        let scan = ScanIndex { radar: 0, scan: 0 };
        let (_, body) = workspace.log.read(scan).unwrap();
        workspace.log.append(scan, u32::MAX as usize, &body).unwrap();
        assert!(workspace.kept(0, 0, &schema).is_none());
    }
}
