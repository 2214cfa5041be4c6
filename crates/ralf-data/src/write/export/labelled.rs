//! What every writer gets: labelled sequences, and scans with their results and effective labels.

use super::options::{Sensors, Split};
use super::{Export, Exported};
use crate::disk::label_file::Label;
use crate::error::DataError;
use crate::read::SequenceReader;
use crate::result::{
    LabelledRun, PlausibilityReader, RadarScanKey, ScanParts, SequenceNames, SequenceRecord, Table,
};
use crate::truth::{Corrections, ScanId};
use ralf::label::truth_of;
use ralf::scene::LocatedScan;
use ralf::sensors::RadarScan;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::sync::Arc;

/// A sequence with its results.
pub(super) struct LabelledSequence<'a, 'p> {
    /// The sequence as recorded.
    pub(super) reader: &'a dyn SequenceReader,
    /// Which detections are asked for.
    pub(super) split: Split,
    /// Which sensors' data are asked for.
    pub(super) sensors: Sensors,
    /// Of the folders and files that it goes to.
    pub(super) names: SequenceNames,
    out: &'a Path,
    corrections: &'a Corrections,
    record: SequenceRecord,
    tables: Tables,
    not_labelled: BTreeSet<RadarScanKey>,
    tally: &'a mut Tally<'p>,
}

/// The results of a sequence. One row group per radar is held in memory, so that going through each radar's scans in
/// order, all radars side by side, reads every group once per radar in it.
struct Tables {
    reader: PlausibilityReader,
    /// Per radar the row group that was read last, and its number.
    held: BTreeMap<Arc<str>, (usize, BTreeMap<usize, Table>)>,
}

impl Tables {
    /// The table of a scan; `None` where there are no rows of it.
    fn table(&mut self, key: &RadarScanKey) -> Result<Option<Table>, DataError> {
        let Some(group) = self.reader.group_of(key) else { return Ok(None) };
        if self.held.get(&key.radar).is_none_or(|(held, _)| *held != group) {
            let tables = self.reader.tables(group)?.into_iter().filter(|(found, _)| found.radar == key.radar);
            let tables = tables.map(|(found, table)| (found.scan, table)).collect();
            self.held.insert(key.radar.clone(), (group, tables));
        }
        Ok(self.held.get(&key.radar).and_then(|(_, tables)| tables.get(&key.scan)).cloned())
    }
}

/// What is exported so far, and who is told.
pub(super) struct Tally<'p> {
    pub(super) exported: Exported,
    pub(super) progress: &'p dyn Fn(usize),
}

/// One scan of one radar with its results: a row per detection, in the order of the recording.
pub(super) struct LabelledScan {
    /// The radar's place in the rig.
    pub(super) radar: usize,
    /// Its number.
    pub(super) scan: usize,
    /// What `ralf label` found; all answers are absent where it could not label the scan.
    pub(super) table: Table,
    /// The effective labels.
    pub(super) labels: Vec<Label>,
    /// The detections of the split, ascending.
    pub(super) kept: Vec<usize>,
}

impl<'a, 'p> LabelledSequence<'a, 'p> {
    /// Opens the results of a sequence.
    pub(super) fn open(
        export: &Export<'a>,
        run: &LabelledRun,
        corrections: &'a Corrections,
        reader: &'a dyn SequenceReader,
        names: SequenceNames,
        tally: &'a mut Tally<'p>,
    ) -> Result<Self, DataError> {
        let crate::result::LabelledSequence { record, tables, .. } = run.sequence(reader)?;
        let tables = Tables { reader: tables, held: BTreeMap::new() };
        let not_labelled = record
            .not_labelled
            .iter()
            .map(|missing| RadarScanKey::new(&missing.radar, missing.scan))
            .collect();
        let Export { out, options, .. } = export;
        let (split, sensors) = (options.split, options.sensors);
        Ok(Self { reader, split, sensors, names, out, corrections, record, tables, not_labelled, tally })
    }

    /// The sequence's name.
    pub(super) fn name(&self) -> &str {
        &self.record.name
    }

    /// How many scans each radar has.
    pub(super) fn scans(&self, radar: usize) -> usize {
        self.reader.sequence().times.radars[radar].len()
    }

    /// A scan, which counts as exported.
    pub(super) fn scan(&mut self, radar: usize, scan: usize) -> Result<LabelledScan, DataError> {
        let sequence = self.reader.sequence();
        let name = &sequence.rig.radars[radar].name;
        let id = self.id(radar, scan);
        self.check_recorded(&id, radar)?;
        let (table, machine) = match self.tables.table(&RadarScanKey::new(name, scan))? {
            Some(table) => {
                let labels = table.labels()?;
                (table, labels)
            }
            None => self.without_rows(&id, radar)?,
        };
        let t_ns = sequence.times.radars[radar][scan];
        if let Some(found) = table.get::<i64>("t_ns")?.first().filter(|found| **found != t_ns) {
            let expected = format!("a scan at {t_ns} ns, as in the recording");
            return Err(self.unlike(&id, expected, found.to_string()));
        }
        let labels = self.corrections.effective_labels(&id, machine)?;
        let kept: Vec<usize> =
            (0..labels.len()).filter(|row| self.split.takes(truth_of(labels[*row].id))).collect();
        self.tally.exported.scans += 1;
        self.tally.exported.detections += kept.len();
        (self.tally.progress)(self.tally.exported.scans);
        Ok(LabelledScan { radar, scan, table, labels, kept })
    }

    /// What a radar measured, which has to be as many detections as were labelled.
    pub(super) fn measured_of(&self, labelled: &LabelledScan) -> Result<RadarScan, DataError> {
        let measured = self.measured(labelled.radar, labelled.scan)?;
        if measured.len() == labelled.labels.len() {
            return Ok(measured);
        }
        let expected = format!("{} detections, as in the recording", measured.len());
        let id = self.id(labelled.radar, labelled.scan);
        Err(self.unlike(&id, expected, labelled.labels.len().to_string()))
    }

    /// What a radar measured. Of a scan that could not be labelled because it can't be read there is nothing to export.
    fn measured(&self, radar: usize, index: usize) -> Result<RadarScan, DataError> {
        let sequence = self.reader.sequence();
        let (sensor, t_ns) = (&sequence.rig.radars[radar], sequence.times.radars[radar][index]);
        self.reader.radar_scan(radar, index).or_else(|error| {
            if self.not_labelled.contains(&RadarScanKey::new(&sensor.name, index)) {
                let columns = vec![Vec::new(); sensor.fields.len()];
                return Ok(RadarScan { t_ns, columns, positions: Vec::new(), spherical: Vec::new() });
            }
            Err(DataError::Measurement { sensor: sensor.name.clone(), index, error })
        })
    }

    /// A scan without rows saw nothing, or could not be labelled, which the record tells.
    fn without_rows(&mut self, id: &ScanId, radar: usize) -> Result<(Table, Vec<Label>), DataError> {
        let sensor = &self.reader.sequence().rig.radars[radar];
        let detections = LocatedScan::new(sensor, self.measured(radar, id.scan as usize)?);
        let found = detections.len();
        if self.not_labelled.contains(&RadarScanKey::new(&sensor.name, id.scan as usize)) {
            self.tally.exported.not_labelled.push(id.to_string());
        } else if found > 0 {
            let expected = format!("{found} detections, as in the recording");
            return Err(self.unlike(id, expected, "none".to_owned()));
        }
        let parts = ScanParts {
            radar: sensor,
            scan: &detections,
            labels: None,
            evidence: &[],
            answers: &[],
            seen: &[],
        };
        let table = Table::of_scan(self.tables.reader.schema(), &parts)?;
        Ok((table, vec![Label::default(); found]))
    }

    /// The table has as many rows of a scan as the record tells.
    fn check_recorded(&self, id: &ScanId, radar: usize) -> Result<(), DataError> {
        let recorded = self.record.radars[radar].detections[id.scan as usize] as usize;
        let found = self.tables.reader.detections(&RadarScanKey::new(&id.radar, id.scan as usize));
        if found == recorded {
            return Ok(());
        }
        Err(self.unlike(id, format!("{recorded} detections, as run.json says"), found.to_string()))
    }

    /// Notes how much later than it was measured the sequence is written, ns.
    pub(super) fn delayed(&mut self, delay_ns: i64) {
        if delay_ns > 0 {
            self.tally.exported.delayed.push((self.record.name.clone(), delay_ns));
        }
    }

    fn id(&self, radar: usize, scan: usize) -> ScanId {
        let sequence = self.reader.sequence();
        let radar = sequence.rig.radars[radar].name.clone();
        ScanId { sequence: sequence.name.clone(), radar, scan: scan as u32 }
    }

    fn unlike(&self, id: &ScanId, expected: String, found: String) -> DataError {
        DataError::content(self.out, id.to_string(), expected, found)
    }
}

impl LabelledScan {
    /// The effective labels where their order is the only key to clouds elsewhere: what the split leaves out is
    /// unlabeled.
    pub(super) fn labels_in_place(&self) -> Vec<Label> {
        let mut labels = vec![Label::default(); self.labels.len()];
        self.kept.iter().for_each(|row| labels[*row] = self.labels[*row]);
        labels
    }

    /// What the radar measured of the detections of the split, a column for each of its fields.
    pub(super) fn kept_of(&self, measured: RadarScan) -> Vec<Vec<f32>> {
        if self.kept.len() == measured.len() {
            return measured.columns;
        }
        let kept = |column: &Vec<f32>| self.kept.iter().map(|row| column[*row]).collect();
        measured.columns.iter().map(kept).collect()
    }
}
