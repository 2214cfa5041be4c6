//! How far two people agree who labelled the same detections, neither of whom saw what the other said.

use crate::error::DataError;
use crate::truth::{Corrections, ScanId};
use ralf::label::truth_of;
use ralf::metrics::Confusion;
use std::collections::BTreeMap;

/// What two people said, scan by scan. Only counts are kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Agreement {
    /// Every scan of which both said something of the same detections, in order; what the first said counts as truth.
    pub scans: Vec<(ScanId, Confusion)>,
}

impl Agreement {
    /// Of the corrections in two output folders, each [bound](Corrections::bound) to what the recording holds. What
    /// somebody corrected or accepted counts, and nothing that the machine alone says.
    ///
    /// # Errors
    /// Corrections of several contents of a scan, of which nothing says which is meant.
    pub fn of(first: &Corrections, second: &Corrections) -> Result<Self, DataError> {
        let mut scans = Vec::new();
        for scan in first.scans() {
            let (Some(one), Some(other)) = (first.truth(scan, None)?, second.truth(scan, None)?) else {
                continue;
            };
            let mut counts = Confusion::default();
            for (one, other) in one.iter().zip(&other) {
                if let (Some(one), Some(other)) = (truth_of(one.id), truth_of(other.id)) {
                    counts.add(one, other);
                }
            }
            if counts.total() > 0 {
                scans.push((scan.clone(), counts));
            }
        }
        Ok(Self { scans })
    }

    /// Over all scans of each sequence.
    pub fn sequences(&self) -> BTreeMap<&str, Confusion> {
        let mut sequences: BTreeMap<&str, Confusion> = BTreeMap::new();
        for (scan, counts) in &self.scans {
            *sequences.entry(&scan.sequence).or_default() += *counts;
        }
        sequences
    }

    /// Over all scans.
    pub fn overall(&self) -> Confusion {
        self.scans.iter().map(|(_, counts)| *counts).sum()
    }

    /// The scans in which they disagree, the most disagreements first.
    pub fn disagreements(&self) -> Vec<&(ScanId, Confusion)> {
        let mut scans: Vec<&(ScanId, Confusion)> =
            self.scans.iter().filter(|(_, counts)| disagreements(counts) > 0).collect();
        scans.sort_by_key(|(_, counts)| std::cmp::Reverse(disagreements(counts)));
        scans
    }
}

/// How many detections one calls plausible and the other doesn't.
pub fn disagreements(counts: &Confusion) -> u64 {
    counts.fp + counts.r#fn
}

/// Cohen's kappa (1960): how much oftener they agree than they would by chance, 1 where always. `None` where chance
/// alone would have them always agree, and of nothing.
///
/// `(p_o - p_e) / (1 - p_e)`, with the share of agreement and what the shares of plausible ones of each lead to.
pub fn kappa(counts: &Confusion) -> Option<f64> {
    let share = |count: u64| count as f64 / counts.total() as f64;
    let agreed = share(counts.tp + counts.tn);
    let (first, second) = (share(counts.tp + counts.r#fn), share(counts.tp + counts.fp));
    let by_chance = first * second + (1.0 - first) * (1.0 - second);
    let kappa = (agreed - by_chance) / (1.0 - by_chance);
    kappa.is_finite().then_some(kappa)
}

#[cfg(test)]
mod tests {
    use super::*;
    use ralf_corrections::{FILE, ScanEdit, Store, Stroke, Who};
    use std::path::Path;

    /// Somebody's corrections: by scan, detections with labels.
    fn said(out: &Path, strokes: &[(u32, u16, &[u32])]) -> Corrections {
        let mut store = Store::open(&out.join(FILE)).unwrap();
        for (scan, label, points) in strokes {
            let points = points.to_vec();
            let edit = ScanEdit {
                radar: "front".into(),
                scan: *scan,
                detections: 6,
                content: None,
                base: 0,
                points,
            };
            let stroke = Stroke { label: Some(*label), scans: vec![edit], ..Stroke::of_sequence("00") };
            store.apply(&stroke, &Who::named("ada")).unwrap();
        }
        Corrections::open(out).unwrap()
    }

    /// The textbook's: of 50 they agree on 20 and 15, where chance would have them agree on half.
    #[test]
    fn kappa_is_what_it_is_by_hand() {
        let found = kappa(&Confusion { tp: 20, r#fn: 5, fp: 10, tn: 15 }).unwrap();
        assert!((found - 0.4).abs() < 1e-12);
        assert_eq!(kappa(&Confusion { tp: 3, ..Confusion::default() }), None);
        assert_eq!(kappa(&Confusion::default()), None);
    }

    #[test]
    fn what_both_said_is_counted_by_hand_and_what_one_alone_said_is_not() {
        let folder = tempfile::tempdir().unwrap();
        let [one, other] = ["one", "other"].map(|name| folder.path().join(name));
        for out in [&one, &other] {
            std::fs::create_dir(out).unwrap();
        }
        // In scan 1 a car and a plausible one are both plausible; in scan 2 they differ twice, and nobody else saw 5.
        let ada = said(&one, &[(1, 10, &[0]), (2, 1, &[0, 1, 2]), (3, 99, &[4])]);
        let bob = said(&other, &[(1, 99, &[0, 3]), (2, 99, &[1, 2, 5])]);
        let found = Agreement::of(&ada, &bob).unwrap();
        let counts: Vec<(u32, Confusion)> =
            found.scans.iter().map(|(scan, counts)| (scan.scan, *counts)).collect();
        let (alike, unlike) =
            (Confusion { tp: 1, ..Confusion::default() }, Confusion { fp: 2, ..Confusion::default() });
        assert_eq!(counts, [(1, alike), (2, unlike)]);
        assert_eq!((found.overall().total(), found.sequences()["00"]), (3, found.overall()));
        assert_eq!(found.disagreements().iter().map(|(scan, _)| scan.scan).collect::<Vec<_>>(), [2]);
    }
}
