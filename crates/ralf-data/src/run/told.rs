//! What the scans of a sequence tell beside their rows: what its record is made of.

use super::Task;
use super::kept::place_of;
use super::without::Without;
use crate::error::DataError;
use crate::result::{
    FileRecord, NotLabelled, Numbers, RadarRecord, ScanNotes, SequenceRecord, Table, UnlikeSisters,
    WithoutNumbers, told_within,
};

/// What a sequence's scans tell, or some of them that follow each other.
#[derive(Default)]
pub(super) struct Told {
    /// In the rig's order.
    radars: Vec<RadarRecord>,
    /// What these delivered.
    numbers: Vec<Numbers>,
    without: Without,
}

impl Told {
    /// Nothing as yet.
    pub(super) fn of(task: &Task) -> Self {
        let radar = |name: &String| RadarRecord { name: name.clone(), ..RadarRecord::default() };
        let radars = task.rig.radars.iter().map(|sensor| radar(&sensor.name)).collect();
        let numbers = task.rig.radars.iter().map(Numbers::of).collect();
        Self { radars, numbers, ..Self::default() }
    }

    /// Adds a radar's next scan: its rows and what else is told of it, or `None` where it could not be labelled.
    ///
    /// # Errors
    /// A table that isn't of a labelled scan of this radar.
    pub(super) fn add(
        &mut self,
        task: &Task,
        radar: usize,
        scan: Option<(&Table, ScanNotes)>,
    ) -> Result<(), DataError> {
        self.radars[radar].push(scan.as_ref().map(|(table, _)| *table))?;
        if let Some((table, notes)) = scan {
            self.numbers[radar].add(&task.rig.radars[radar], table)?;
            self.without.add(notes);
        }
        Ok(())
    }

    /// Adds what the scans behind these tell.
    pub(super) fn append(&mut self, more: Self) {
        for (radar, more) in self.radars.iter_mut().zip(more.radars) {
            radar.append(more);
        }
        for (numbers, more) in self.numbers.iter_mut().zip(&more.numbers) {
            numbers.append(more);
        }
        self.without.append(more.without);
    }

    /// The record of the sequence, whose table, if it has one, is this file.
    pub(super) fn record(
        self,
        task: &Task,
        table: Option<FileRecord>,
        not_labelled: Vec<NotLabelled>,
        fingerprint: &str,
    ) -> SequenceRecord {
        let (unlike_sisters, without_numbers) = (self.unlike_sisters(), self.without_numbers(task));
        let Self { radars, without, .. } = self;
        let missing = not_labelled.iter().map(|scan| (scan.radar.as_str(), scan.scan)).collect();
        let (unreadable, not_read) = without.named(&missing);
        SequenceRecord {
            name: task.reader.sequence().name.clone(),
            fingerprint: fingerprint.to_owned(),
            recording: place_of(task.root),
            table,
            unlike_sisters,
            without_numbers,
            radars,
            cameras: without.cameras(&task.rig.cameras),
            not_labelled,
            lost: task.reader.lost().iter().map(|lost| told_within(lost, task.root)).collect(),
            motion: task.reader.motion_source(),
            unreadable,
            not_read,
        }
    }

    /// Radars whose labels are unlike those of the others, among those that have places at all.
    fn unlike_sisters(&self) -> Vec<UnlikeSisters> {
        let radars = self.radars.iter().zip(&self.numbers).filter(|(_, numbers)| numbers.has_place());
        UnlikeSisters::of(&radars.map(|(radar, _)| radar.counts()).collect::<Vec<_>>())
    }

    fn without_numbers(&self, task: &Task) -> Vec<WithoutNumbers> {
        let radars = self.numbers.iter().zip(&task.rig.radars);
        radars.filter_map(|(numbers, radar)| numbers.missing(radar)).collect()
    }
}
