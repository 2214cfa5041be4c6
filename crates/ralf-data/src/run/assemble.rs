//! Putting a sequence's labelled scans together, in the order of the rig: row groups of its table are read and encoded
//! side by side, and written in their order.

use super::told::Told;
use super::workspace::Workspace;
use super::{Observer, Stage, Task};
use crate::error::DataError;
use crate::frames::{ScanIndex, all_scans};
use crate::result::{
    EncodedGroup, FileRecord, GROUP_ROWS, Layout, NotLabelled, PlausibilityWriter, RadarScanKey, RowGroup,
    SequenceRecord, written,
};
use ralf_jobs::side_by_side;
use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

/// What is put together, and from what.
struct Assembly<'a> {
    task: &'a Task<'a>,
    workspace: &'a Workspace<'a>,
    /// Those that could not be labelled, by radar.
    missing: BTreeSet<(&'a str, usize)>,
    layout: &'a Layout,
    file: PathBuf,
    observer: &'a dyn Observer,
}

/// Writes `plausibility.parquet` of a sequence from its scans' tables, with so many threads.
pub(super) fn assemble(
    task: &Task,
    fingerprint: &str,
    workspace: &Workspace,
    not_labelled: Vec<NotLabelled>,
    jobs: usize,
    observer: &dyn Observer,
) -> Result<SequenceRecord, DataError> {
    let sequence = task.reader.sequence();
    observer.begin(Stage::Writing(&sequence.name), task.scans() as u64);
    let file = workspace.plausibility_file();
    let writer = PlausibilityWriter::create(&file, &task.schema)?;
    let layout = writer.layout().clone();
    let missing = not_labelled.iter().map(|scan| (scan.radar.as_str(), scan.scan)).collect();
    let assembly = Assembly { task, workspace, missing, layout: &layout, file, observer };
    let groups: Vec<_> = assembly.groups().into_iter().enumerate().collect();
    let ordered = InOrder::new(writer);
    let told = side_by_side(&groups, jobs, |(number, scans)| {
        let (group, told) = assembly.group(scans)?;
        ordered.append(*number, group).map(|()| told)
    })?;
    let mut all = Told::of(task);
    told.into_iter().for_each(|told| all.append(told));
    let table = Some(ordered.finish()?);
    observer.end();
    Ok(all.record(task, table, not_labelled, fingerprint))
}

impl Assembly<'_> {
    /// The scans of each row group, in their order; one group at least.
    fn groups(&self) -> Vec<Vec<ScanIndex>> {
        let (mut groups, mut group, mut rows) = (Vec::new(), Vec::new(), 0);
        for scan in all_scans(&self.task.reader.sequence().times) {
            group.push(scan);
            rows += if self.is_missing(scan) { 0 } else { self.workspace.rows(scan) };
            if rows >= GROUP_ROWS {
                groups.push(std::mem::take(&mut group));
                rows = 0;
            }
        }
        groups.push(group);
        groups
    }

    fn is_missing(&self, ScanIndex { radar, scan }: ScanIndex) -> bool {
        self.missing.contains(&(self.task.rig.radars[radar].name.as_str(), scan))
    }

    /// These scans' rows, and what else they tell. Without rows there is no group.
    fn group(&self, scans: &[ScanIndex]) -> Result<(Option<EncodedGroup>, Told), DataError> {
        let schema = &self.task.schema;
        let mut told = Told::of(self.task);
        let present = scans.iter().filter(|scan| !self.is_missing(**scan));
        let rows: usize = present.map(|scan| self.workspace.rows(*scan)).sum();
        let mut group = RowGroup::with_room(schema, rows);
        for index @ ScanIndex { radar, scan } in scans.iter().copied() {
            if self.is_missing(index) {
                told.add(self.task, radar, None)?;
                self.observer.advance(1, 0);
                continue;
            }
            if self.observer.stopped() {
                return Err(DataError::Stopped);
            }
            let (table, notes) = self.workspace.scan(radar, scan, schema)?;
            group.append(&RadarScanKey::new(&self.task.rig.radars[radar].name, scan), &table)?;
            told.add(self.task, radar, Some((&table, notes)))?;
            self.observer.advance(1, table.len() as u64);
        }
        if rows == 0 {
            return Ok((None, told));
        }
        let group = group.encode(self.layout).map_err(|error| written(&self.file, error))?;
        Ok((Some(group), told))
    }
}

/// Row groups that are encoded in any order and written in theirs.
struct InOrder(Mutex<Waiting>);

struct Waiting {
    writer: PlausibilityWriter,
    /// The number of the group that is written next.
    next: usize,
    /// Those behind it that are encoded already; one that is `None` has no rows.
    encoded: BTreeMap<usize, Option<EncodedGroup>>,
}

impl InOrder {
    fn new(writer: PlausibilityWriter) -> Self {
        Self(Mutex::new(Waiting { writer, next: 0, encoded: BTreeMap::new() }))
    }

    /// Writes a group as soon as all those before it are.
    fn append(&self, number: usize, group: Option<EncodedGroup>) -> Result<(), DataError> {
        // Should a writer panic, the whole run does.
        let mut waiting = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.encoded.insert(number, group);
        loop {
            let next = waiting.next;
            let Some(group) = waiting.encoded.remove(&next) else { return Ok(()) };
            waiting.next += 1;
            group.map_or(Ok(()), |group| waiting.writer.append_group(group))?;
        }
    }

    fn finish(self) -> Result<FileRecord, DataError> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner).writer.finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::result::{Kind, PlausibilityReader, Schema, Table, Values};
    use ralf::sensors::Rig;

    #[test]
    fn groups_are_written_in_their_order_whoever_is_first() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("plausibility.parquet");
        let schema = Schema::of(&Rig::default(), &[]).unwrap().into();
        let writer = PlausibilityWriter::create(&file, &schema).unwrap();
        let layout = writer.layout().clone();
        let group = |scan: usize| {
            let value = |kind| match kind {
                Kind::I64 => Values::I64(vec![scan as i64]),
                Kind::F32 => Values::F32(vec![scan as f32]),
                Kind::U8 => Values::U8(vec![1]),
                Kind::U16 => Values::U16(vec![0]),
                Kind::Class => Values::Class(vec![None]),
                _ => Values::U32(vec![0]),
            };
            let values = schema.columns().iter().map(|column| value(column.kind)).collect();
            let mut group = RowGroup::with_room(&schema, 1);
            group
                .append(&RadarScanKey::new("front", scan), &Table::new(schema.clone(), values).unwrap())
                .unwrap();
            group.encode(&layout).unwrap()
        };
        let ordered = InOrder::new(writer);
        for (number, group) in [(2, Some(group(7))), (0, Some(group(3))), (3, Some(group(9))), (1, None)] {
            ordered.append(number, group).unwrap();
        }
        ordered.finish().unwrap();
        let mut seen = Vec::new();
        let reader = PlausibilityReader::open(&file, &schema).unwrap();
        let see = |key: &RadarScanKey, table: &Table| {
            seen.push((key.scan, table.get::<f32>("w")?[0]));
            Ok::<_, DataError>(())
        };
        reader.each(&["w"], see).unwrap();
        assert_eq!(seen, [(3, 3.0), (7, 7.0), (9, 9.0)]);
    }
}
