//! What weighs most in a model's answers: of each group of evidence, in how many detections no other adds as much.

use crate::ReportError;
use ralf::evidence::GROUPS;
use ralf::learned::NEIGHBOURS;
use ralf_data::result::{PlausibilityReader, Table, share_column};
use std::sync::Arc;

/// How often a group of evidence weighs most.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Weight {
    /// The group.
    pub(crate) group: &'static str,
    /// Artifacts and plausible detections in which no other group adds as much to the log odds, up or down.
    pub(crate) counts: [u64; 2],
    /// The largest of these shares, log odds without a sign, and what is said of that detection in words.
    pub(crate) most: (f32, Arc<str>),
}

impl Weight {
    fn none(group: &'static str) -> Self {
        Self { group, counts: [0; 2], most: (0.0, "".into()) }
    }

    fn add(&mut self, share: f32, label: u8, words: &Arc<str>) {
        self.counts[usize::from(label == 1)] += 1;
        if share > self.most.0 {
            self.most = (share, words.clone());
        }
    }
}

/// Adds the reasons of a sequence, where a model gave some.
pub(crate) fn add(weights: &mut Vec<Weight>, tables: &PlausibilityReader) -> Result<(), ReportError> {
    let groups = GROUPS.into_iter().chain([NEIGHBOURS]);
    let is_there = |name: &String| tables.schema().columns().iter().any(|column| column.name == **name);
    // Programs before this one told of no neighbours.
    let shares: Vec<(usize, String)> =
        groups.clone().map(share_column).enumerate().filter(|(_, name)| is_there(name)).collect();
    if shares.is_empty() {
        return Ok(());
    }
    if weights.is_empty() {
        weights.extend(groups.map(Weight::none));
    }
    let names: Vec<&str> = shares.iter().map(|(_, name)| name.as_str()).chain(["label", "reason"]).collect();
    tables.each(&names, |_, table| add_scan(weights, &shares, table))
}

fn add_scan(weights: &mut [Weight], shares: &[(usize, String)], table: &Table) -> Result<(), ReportError> {
    let column = |(group, name): &(usize, String)| table.get::<f32>(name).map(|column| (*group, column));
    let columns = shares.iter().map(column).collect::<Result<Vec<_>, _>>()?;
    let (labels, words) = (table.get::<u8>("label")?, table.get::<Arc<str>>("reason")?);
    for (row, (label, words)) in labels.iter().zip(words).enumerate() {
        let sizes = columns.iter().map(|(group, column)| (*group, column[row].abs()));
        // What the paper's method answered has none.
        let largest = sizes.filter(|(_, size)| !size.is_nan()).max_by(|a, b| a.1.total_cmp(&b.1));
        if let Some((group, size)) = largest {
            weights[group].add(size, *label, words);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_detection_in_which_a_group_adds_most_is_kept() {
        let mut weight = Weight::none("Doppler");
        for (share, label, words) in [(1.0, 0, "a"), (2.5, 1, "b"), (2.0, 0, "c")] {
            weight.add(share, label, &words.into());
        }
        assert_eq!(weight, Weight { group: "Doppler", counts: [2, 1], most: (2.5, "b".into()) });
    }
}
