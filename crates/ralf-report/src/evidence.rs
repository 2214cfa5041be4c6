//! What each column of evidence says of what is labelled plausible and of artifacts, whatever columns there are.

use crate::ReportError;
use ralf_data::result::{Column, Group, PlausibilityReader};

/// A column of evidence over the detections of a run.
#[derive(Debug, Clone)]
pub(crate) struct EvidenceColumn {
    /// The column.
    pub(crate) column: Column,
    /// How many of the artifacts, and of the plausible ones, have a value.
    pub(crate) counts: [u64; 2],
    sums: [f64; 2],
}

impl EvidenceColumn {
    /// The mean over what is labelled plausible, or over the artifacts; `None` where none has a value.
    pub(crate) fn mean(&self, plausible: bool) -> Option<f64> {
        let label = usize::from(plausible);
        (self.counts[label] > 0).then(|| self.sums[label] / self.counts[label] as f64)
    }

    fn add(&mut self, values: &[f32], labels: &[u8]) {
        for (value, label) in values.iter().zip(labels).filter(|(value, _)| value.is_finite()) {
            let label = usize::from(*label == 1);
            self.counts[label] += 1;
            self.sums[label] += f64::from(*value);
        }
    }
}

/// Adds the evidence of a sequence, a column of which is there only where it was gathered.
pub(crate) fn add(
    evidence: &mut Vec<EvidenceColumn>,
    tables: &PlausibilityReader,
) -> Result<(), ReportError> {
    let columns = tables.schema().columns().iter().filter(|column| column.group == Group::Evidence);
    let columns: Vec<Column> = columns.cloned().collect();
    let names: Vec<&str> = columns.iter().map(|column| column.name.as_ref()).chain(["label"]).collect();
    if columns.is_empty() {
        return Ok(());
    }
    for column in &columns {
        if evidence.iter().all(|known| known.column.name != column.name) {
            evidence.push(EvidenceColumn { column: column.clone(), counts: [0; 2], sums: [0.0; 2] });
        }
    }
    tables.each(&names, |_, table| {
        let labels = table.get::<u8>("label")?;
        for observed in evidence.iter_mut().filter(|observed| names.contains(&observed.column.name.as_ref()))
        {
            observed.add(table.get::<f32>(&observed.column.name)?, labels);
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_data::result::Kind;

    #[test]
    fn means_are_worked_out_by_hand_and_what_is_absent_does_not_count() {
        let column = Column {
            name: "d".into(),
            kind: Kind::F32,
            unit: "m",
            meaning: "a distance",
            group: Group::Evidence,
        };
        let mut observed = EvidenceColumn { column, counts: [0; 2], sums: [0.0; 2] };
        assert_eq!((observed.mean(true), observed.mean(false)), (None, None));
        observed.add(&[1.0, f32::NAN, 3.0, 8.0], &[1, 1, 1, 0]);
        observed.add(&[f32::NAN], &[0]);
        assert_eq!(
            (observed.mean(true), observed.mean(false), observed.counts),
            (Some(2.0), Some(8.0), [1, 2])
        );
    }
}
