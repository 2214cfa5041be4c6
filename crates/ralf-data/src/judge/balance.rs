//! What a run's results say without ground truth (docs/method.md, section 9): how far apart the classes are, and how balanced.

use crate::error::DataError;
use crate::result::{LabelledRows, LabelledRun, read_labelled_rows};
use ralf::metrics::Separation;
use serde::Serialize;
use std::collections::BTreeMap;
use std::path::Path;

/// Distinctiveness and class balance of some detections.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize)]
pub struct Balance {
    /// How many.
    pub detections: u64,
    /// Of these labelled plausible.
    pub plausible: u64,
    /// Of these labelled artifact.
    pub artifact: u64,
    /// Share of detections labelled plausible; `None` without detections.
    pub plausible_share: Option<f64>,
    /// Mean `w` of what is labelled plausible minus mean `w` of what is labelled artifact; `None` where a class is empty.
    pub distinctiveness: Option<f64>,
}

/// The balance of a whole run: what `ralf evaluate --json` prints without ground truth.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Balances {
    /// Of all detections.
    pub overall: Balance,
    /// Of each radar in all sequences.
    pub radars: BTreeMap<String, Balance>,
    /// Of each sequence.
    pub sequences: BTreeMap<String, Balance>,
}

impl From<Separation> for Balance {
    fn from(found: Separation) -> Self {
        Self {
            detections: found.plausible + found.artifact,
            plausible: found.plausible,
            artifact: found.artifact,
            plausible_share: found.plausible_share(),
            distinctiveness: found.distinctiveness(),
        }
    }
}

impl Balances {
    /// Reads the table of every sequence that a run has labelled.
    ///
    /// # Errors
    /// A folder without results, or with damaged ones.
    pub fn of_run(out: &Path) -> Result<Self, DataError> {
        let run = LabelledRun::open(out)?;
        let mut sums = Sums::default();
        for record in &run.record().sequences {
            sums.add(record.name.clone(), &read_labelled_rows(&run.table_file(record)?)?);
        }
        Ok(sums.into())
    }
}

/// Running sums over a run.
#[derive(Default)]
struct Sums {
    overall: Separation,
    radars: BTreeMap<String, Separation>,
    sequences: BTreeMap<String, Separation>,
}

impl Sums {
    fn add(&mut self, sequence: String, rows: &LabelledRows) {
        let of_sequence = self.sequences.entry(sequence).or_default();
        for ((radar, w), label) in rows.radar.iter().zip(&rows.w).zip(&rows.label) {
            let (w, plausible) = (f64::from(*w), *label == 1);
            self.overall.add(w, plausible);
            of_sequence.add(w, plausible);
            match self.radars.get_mut(&rows.radars[*radar]) {
                Some(of_radar) => of_radar.add(w, plausible),
                None => drop(
                    self.radars.insert(rows.radars[*radar].clone(), [(w, plausible)].into_iter().collect()),
                ),
            }
        }
    }
}

impl From<Sums> for Balances {
    fn from(Sums { overall, radars, sequences }: Sums) -> Self {
        let of_all = |sums: BTreeMap<String, Separation>| {
            sums.into_iter().map(|(name, sum)| (name, Balance::from(sum))).collect()
        };
        Self { overall: overall.into(), radars: of_all(radars), sequences: of_all(sequences) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Worked out by hand.
    #[test]
    fn sums_are_kept_by_radar_and_by_sequence() {
        let rows = |radars: [&str; 2], w: [f32; 3], label: [u8; 3]| LabelledRows {
            radars: radars.map(str::to_owned).to_vec(),
            radar: vec![0, 1, 1],
            w: w.to_vec(),
            label: label.to_vec(),
            ..LabelledRows::default()
        };
        let mut sums = Sums::default();
        sums.add("00".into(), &rows(["front", "back"], [1.0, 0.25, 0.0], [1, 0, 0]));
        sums.add("01".into(), &rows(["back", "front"], [0.75, 0.5, 0.0], [1, 1, 0]));
        let found = Balances::from(sums);
        let balance = |plausible, artifact, distinctiveness| Balance {
            detections: plausible + artifact,
            plausible,
            artifact,
            plausible_share: Some(plausible as f64 / (plausible + artifact) as f64),
            distinctiveness,
        };
        assert_eq!(found.overall, balance(3, 3, Some(0.75 - 0.25 / 3.0)));
        assert_eq!(found.sequences["00"], balance(1, 2, Some(0.875)));
        assert_eq!(found.sequences["01"], balance(2, 1, Some(0.625)));
        assert_eq!(found.radars["front"], balance(2, 1, Some(0.75)));
        assert_eq!(found.radars["back"], balance(1, 2, Some(0.625)));
        assert_eq!(Balance::from(Separation::default()), Balance::default());
    }

    #[test]
    fn no_results_are_an_error_that_names_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let error = Balances::of_run(folder.path()).unwrap_err().to_string();
        let expected = "run.json: expected the record of a finished `ralf label`, found no such file";
        assert!(error.ends_with(expected), "{error}");
    }
}
