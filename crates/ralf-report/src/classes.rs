//! Which classes plausible detections have, and which sensor tells them.

use crate::ReportError;
use ralf_data::DataError;
use ralf_data::result::{ClassSource, PlausibilityReader, Table};
use std::collections::BTreeMap;

/// Plausible detections by class; of sequences whose images have segmentations.
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

/// Adds the classes of a sequence, where it says what tells them.
pub(crate) fn add(classes: &mut Option<Classes>, tables: &PlausibilityReader) -> Result<(), ReportError> {
    const COLUMNS: [&str; 3] = ["label", "semantic", "class_from"];
    if tables.schema().only(&COLUMNS).is_err() {
        return Ok(());
    }
    let classes = classes.get_or_insert_default();
    tables.each(&COLUMNS, |_, table| Ok(classes.add(table)?))
}
