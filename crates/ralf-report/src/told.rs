//! What a model tells of detections in words: why they are artifacts, and how the LiDARs see their places.

use crate::ReportError;
use ralf_data::result::{Group, PlausibilityReader};
use std::collections::BTreeMap;
use std::sync::Arc;

/// Columns of words of which there are few: those that are counted.
const COUNTED: [&str; 2] = ["cause", "visibility"];

/// How often each word of a column is told.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Told {
    /// The column's name.
    pub(crate) column: String,
    /// Artifacts and plausible detections, by word.
    pub(crate) counts: BTreeMap<Arc<str>, [u64; 2]>,
}

impl Told {
    fn add(&mut self, words: &[Arc<str>], labels: &[u8]) {
        for (word, label) in words.iter().zip(labels).filter(|(word, _)| !word.is_empty()) {
            self.counts.entry(word.clone()).or_default()[usize::from(*label == 1)] += 1;
        }
    }
}

/// Adds what is told of a sequence, where a model was asked.
pub(crate) fn add(told: &mut Vec<Told>, tables: &PlausibilityReader) -> Result<(), ReportError> {
    let columns = tables.schema().columns().iter().filter(|column| column.group == Group::Words);
    let columns = columns.map(|column| column.name.to_string());
    let columns: Vec<String> = columns.filter(|name| COUNTED.contains(&name.as_str())).collect();
    if columns.is_empty() {
        return Ok(());
    }
    for column in &columns {
        if told.iter().all(|known| known.column != *column) {
            told.push(Told { column: column.clone(), counts: BTreeMap::new() });
        }
    }
    let names: Vec<&str> = columns.iter().map(String::as_str).chain(["label"]).collect();
    tables.each(&names, |_, table| {
        let labels = table.get::<u8>("label")?;
        for told in told.iter_mut().filter(|told| columns.contains(&told.column)) {
            told.add(table.get::<Arc<str>>(&told.column)?, labels);
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_counted_by_label_and_what_is_not_told_is_not() {
        let mut told = Told { column: "cause".to_owned(), counts: BTreeMap::new() };
        told.add(&["mirror", "", "road", "mirror"].map(Arc::from), &[0, 1, 0, 1]);
        let expected = [("mirror", [1, 1]), ("road", [1, 0])].map(|(word, counts)| (Arc::from(word), counts));
        assert_eq!(told.counts, BTreeMap::from(expected));
    }
}
