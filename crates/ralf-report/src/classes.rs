//! Which classes plausible detections have, and which sensor tells them.

use crate::ReportError;
use ralf_data::DataError;
use ralf_data::result::{ClassSource, PlausibilityReader, Table};
use std::collections::BTreeMap;

/// Plausible detections by class; of sequences in which a sensor tells classes.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub(crate) struct Classes {
    /// By SemanticKITTI id: how many each of [`ClassSource::ALL`] tells.
    pub(crate) counts: BTreeMap<u16, [u64; ClassSource::ALL.len()]>,
    /// Those without a class.
    pub(crate) without: u64,
}

impl Classes {
    /// How many there are, with a class and without.
    pub(crate) fn total(&self) -> u64 {
        self.counts.values().flatten().sum::<u64>() + self.without
    }

    fn merge(&mut self, other: Self) {
        for (class, counts) in other.counts {
            let mine = self.counts.entry(class).or_default();
            mine.iter_mut().zip(counts).for_each(|(mine, count)| *mine += count);
        }
        self.without += other.without;
    }

    fn add(&mut self, table: &Table) -> Result<(), DataError> {
        let labels = table.get::<u8>("label")?.iter().zip(table.labels()?);
        for ((plausible, label), source) in labels.zip(table.class_sources()?) {
            match source {
                Some(source) => self.counts.entry(label.id).or_default()[source as usize] += 1,
                None => self.without += u64::from(*plausible == 1),
            }
        }
        Ok(())
    }
}

/// Adds the classes of a sequence: one whose images have segmentations, or whose LiDARs told some. Results of the
/// latter have no column that says so.
pub(crate) fn add(classes: &mut Option<Classes>, tables: &PlausibilityReader) -> Result<(), ReportError> {
    const COLUMNS: [&str; 3] = ["label", "semantic", "class_from"];
    let cameras_asked = tables.schema().only(&COLUMNS).is_ok();
    let columns = if cameras_asked { &COLUMNS[..] } else { &COLUMNS[..2] };
    let mut found = Classes::default();
    tables.each(columns, |_, table| Ok::<_, ReportError>(found.add(table)?))?;
    if cameras_asked || !found.counts.is_empty() {
        classes.get_or_insert_default().merge(found);
    }
    Ok(())
}
