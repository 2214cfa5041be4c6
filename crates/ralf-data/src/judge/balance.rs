//! What a run's results say without ground truth (docs/method.md, section 9): how far apart the classes are, and how
//! balanced.

use crate::error::DataError;
use crate::result::{LabelledRun, Table};
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
    /// Mean `w` of what is labelled plausible minus mean `w` of what is labelled artifact; `None` where a class is
    /// empty.
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
            sums.sequences.entry(record.name.clone()).or_default();
            // One that has seen nothing has no row in the table.
            for radar in &record.radars {
                sums.radars.entry(radar.name.clone()).or_default();
            }
            run.table(record)?
                .each(&["w", "label"], |scan, table| sums.add(&record.name, &scan.radar, table))?;
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
    fn add(&mut self, sequence: &str, radar: &str, table: &Table) -> Result<(), DataError> {
        let of_sequence = self.sequences.entry(sequence.to_owned()).or_default();
        let of_radar = self.radars.entry(radar.to_owned()).or_default();
        for (w, label) in table.get::<f32>("w")?.iter().zip(table.get::<u8>("label")?) {
            let (w, plausible) = (f64::from(*w), *label == 1);
            self.overall.add(w, plausible);
            of_sequence.add(w, plausible);
            of_radar.add(w, plausible);
        }
        Ok(())
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
    use crate::result::{Schema, Values};
    use ralf::sensors::Rig;

    /// Worked out by hand.
    #[test]
    fn sums_are_kept_by_radar_and_by_sequence() {
        let schema = Schema::of(&Rig::default(), &[]).unwrap().only(&["w", "label"]).unwrap();
        let rows = |w: &[f32], label: &[u8]| {
            Table::new(schema.clone(), vec![Values::F32(w.to_vec()), Values::U8(label.to_vec())]).unwrap()
        };
        let mut sums = Sums::default();
        sums.add("00", "front", &rows(&[1.0], &[1])).unwrap();
        sums.add("00", "back", &rows(&[0.25, 0.0], &[0, 0])).unwrap();
        sums.add("01", "back", &rows(&[0.75], &[1])).unwrap();
        sums.add("01", "front", &rows(&[0.5, 0.0], &[1, 0])).unwrap();
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
