//! Labels of a run against the corrected ones (docs/method.md, section 9): the label files are all that is needed.

use crate::disk::files;
use crate::disk::label_file::Label;
use crate::error::DataError;
use crate::result::{LabelledRun, under_way};
use crate::tree::{RECORD, SEQUENCES};
use crate::truth::{GroundTruth, ScanId};
use ralf::label::truth_of;
use ralf::metrics::{Confusion, Evaluation};
use std::collections::BTreeSet;
use std::path::Path;

/// A run compared with the truth, scan by scan. Only counts are kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Every scan that has truth and labels, in order.
    pub scans: Vec<(ScanId, Confusion)>,
    /// Scans with truth that the run gave no labels; they are left out.
    pub missing: Vec<ScanId>,
    /// Sequences of the run without truth; they are left out.
    pub without_truth: Vec<String>,
}

/// Scans with truth that a run gave no labels, summed up as far as that tells the same.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Missing<'a> {
    /// Sequences of which no scan has labels.
    pub sequences: Vec<&'a String>,
    /// Of the others the radars of which no scan has any, by sequence and radar.
    pub radars: Vec<(&'a str, &'a str)>,
    /// All other scans.
    pub scans: Vec<&'a ScanId>,
}

impl Comparison {
    /// Compares what a run wrote to the folder `out` with the truth. Label files are enough; where there is a
    /// `run.json`, they have to be as it tells. Refused are scans of another size than their truth,
    /// labels of 0 (unlabeled), a run that has not ended, and one that labelled none of the scans with truth.
    pub fn new(out: &Path, truth: &GroundTruth) -> Result<Self, DataError> {
        let run = run_of(out)?;
        refuse_begun(out, run.as_ref(), truth)?;
        let (mut scans, mut missing) = (Vec::new(), Vec::new());
        for scan in truth.scans() {
            match compare(out, run.as_ref(), truth, scan)? {
                Some(counts) => scans.push((scan.clone(), counts)),
                None => missing.push(scan.clone()),
            }
        }
        let sequences = out.join(SEQUENCES);
        if scans.is_empty() {
            let place = "*/*/NNNNNN.label";
            return Err(DataError::content(&sequences, place, "labels of scans that have truth", "none"));
        }
        let mut without_truth = files::folders(&sequences)?;
        without_truth.retain(|name| truth.scans().iter().all(|scan| scan.sequence != *name));
        Ok(Self { scans, missing, without_truth })
    }

    /// What is missing: nobody asked for whole sequences or radars, which are told once.
    pub fn missing_parts(&self) -> Missing<'_> {
        let mut labelled = BTreeSet::new();
        for (scan, _) in &self.scans {
            let sequence = scan.sequence.as_str();
            labelled.extend([(sequence, None), (sequence, Some(scan.radar.as_str()))]);
        }
        let mut missing = Missing::default();
        for scan in &self.missing {
            let (sequence, radar) = (scan.sequence.as_str(), scan.radar.as_str());
            if !labelled.contains(&(sequence, None)) {
                missing.sequences.push(&scan.sequence);
            } else if !labelled.contains(&(sequence, Some(radar))) {
                missing.radars.push((sequence, radar));
            } else {
                missing.scans.push(scan);
            }
        }
        missing.sequences.dedup();
        missing.radars.dedup();
        missing
    }

    /// The metrics of all scans.
    pub fn evaluation(&self) -> Evaluation {
        Evaluation::from_scans(self.scans.iter().map(|(scan, counts)| (scan.sequence.as_str(), *counts)))
    }
}

/// The run that wrote these labels; `None` where others have made them.
fn run_of(out: &Path) -> Result<Option<LabelledRun>, DataError> {
    if !files::exists(out)? {
        let expected = "labels of `ralf label`, or files of labels";
        return Err(DataError::content(out, "folder", expected, "no such folder"));
    }
    let is_of_ralf = files::exists(&out.join(RECORD))? || under_way::is_under_way(out)?;
    is_of_ralf.then(|| LabelledRun::open(out)).transpose()
}

/// Refuses to judge sequences that a run has begun and not finished.
fn refuse_begun(out: &Path, run: Option<&LabelledRun>, truth: &GroundTruth) -> Result<(), DataError> {
    let Some(run) = run else { return Ok(()) };
    let names: BTreeSet<&str> = truth.scans().iter().map(|scan| scan.sequence.as_str()).collect();
    for name in names.into_iter().filter(|name| !run.holds(name)) {
        if under_way::is_begun(out, name)? {
            return Err(DataError::content(
                out,
                format!("sequence {name}"),
                "labels of all scans",
                under_way::FOUND,
            ));
        }
    }
    Ok(())
}

/// The confusion matrix of one scan; `None` where the run has no labels for it.
fn compare(
    out: &Path,
    run: Option<&LabelledRun>,
    truth: &GroundTruth,
    scan: &ScanId,
) -> Result<Option<Confusion>, DataError> {
    let file = scan.label_file(out);
    let labels = LabelledRun::labels_below(out, run, &scan.sequence, &scan.radar, scan.scan as usize)?;
    let Some(labels) = labels else { return Ok(None) };
    let truths = truth.labels(scan)?;
    if labels.len() != truths.len() {
        let expected = format!("{} as in its ground truth", truths.len());
        return Err(DataError::content(&file, "number of labels", expected, labels.len().to_string()));
    }
    count(&labels, &truths)
        .map(Some)
        .map_err(|row| DataError::content(&file, format!("row {row} (from 0)"), "a label", "0 (unlabeled)"))
}

/// Counts the detections that the truth says something of. The error is the first row that the run left unlabeled.
fn count(labels: &[Label], truths: &[Label]) -> Result<Confusion, usize> {
    let mut counts = Confusion::default();
    for (row, (label, truth)) in labels.iter().zip(truths).enumerate() {
        let label = truth_of(label.id).ok_or(row)?;
        if let Some(truth) = truth_of(truth.id) {
            counts.add(truth, label);
        }
    }
    Ok(counts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::disk::label_file::write_labels;
    use serde_json::{Value, json};
    use std::fs;

    /// A run in `out` and a dataset in `dataset`, made of single label files.
    struct Folders(tempfile::TempDir);

    impl Folders {
        fn new() -> Self {
            Self(tempfile::tempdir().unwrap())
        }

        fn put(&self, name: &str, ids: &[u16]) {
            let labels: Vec<Label> = ids.iter().copied().map(Label::of_class).collect();
            write_labels(&self.0.path().join(name), &labels).unwrap();
        }

        fn pair(&self, sequence: &str, file: &str, labels: &[u16], truth: &[u16]) {
            self.put(&format!("out/sequences/{sequence}/{file}"), labels);
            self.put(&format!("dataset/sequences/{sequence}/ground_truth/{file}"), truth);
        }

        fn compare(&self) -> Result<Comparison, DataError> {
            let truth = GroundTruth::open(&self.0.path().join("dataset"))?;
            Comparison::new(&self.0.path().join("out"), &truth)
        }

        fn refusal(&self) -> String {
            self.compare().unwrap_err().to_string()
        }
    }

    fn id(sequence: &str, radar: &str, scan: u32) -> ScanId {
        ScanId { sequence: sequence.into(), radar: radar.into(), scan }
    }

    #[test]
    fn ids_are_read_as_plausible_or_artifact_and_unlabeled_truth_is_ignored() {
        let folders = Folders::new();
        // Right: car as 99, road as 1; wrong: sidewalk as 99, person as 1 and as lane-marking.
        folders.pair("00", "front/000002.label", &[99, 1, 99, 1, 60, 1, 99], &[10, 40, 48, 254, 30, 0, 0]);
        let found = folders.compare().unwrap();
        assert_eq!(found.scans, [(id("00", "front", 2), Confusion { tp: 1, fp: 1, tn: 1, r#fn: 2 })]);
        assert!(found.missing.is_empty() && found.without_truth.is_empty());
    }

    #[test]
    fn an_instance_changes_nothing() {
        let folders = Folders::new();
        folders.pair("00", "front/000000.label", &[99], &[10]);
        let file = folders.0.path().join("dataset/sequences/00/ground_truth/front/000000.label");
        write_labels(&file, &[Label { id: 10, instance: 7 }]).unwrap();
        assert_eq!(folders.compare().unwrap().scans[0].1.tp, 1);
    }

    #[test]
    fn scans_without_labels_and_sequences_without_truth_are_named_and_left_out() {
        let folders = Folders::new();
        folders.pair("00", "front/000000.label", &[99], &[99]);
        folders.put("dataset/sequences/00/ground_truth/front/000001.label", &[99]);
        folders.put("dataset/sequences/01/ground_truth/rear/000000.label", &[1]);
        folders.put("out/sequences/02/front/000000.label", &[1]);
        let found = folders.compare().unwrap();
        assert_eq!(found.missing, [id("00", "front", 1), id("01", "rear", 0)]);
        assert_eq!(found.without_truth, ["02"]);
        let Missing { sequences, radars, scans } = found.missing_parts();
        assert_eq!((sequences, radars), (vec![&"01".to_owned()], vec![]), "nobody asked for it");
        assert_eq!(scans, [&id("00", "front", 1)]);
        let evaluation = found.evaluation();
        assert_eq!(evaluation.sequences.keys().collect::<Vec<_>>(), ["00"]);
        assert_eq!(evaluation.overall.pooled.counts.total(), 1);
    }

    #[test]
    fn what_does_not_fit_is_named() {
        let folders = Folders::new();
        folders.pair("00", "front/000000.label", &[99, 1], &[99, 1, 1]);
        let error = folders.refusal();
        let expected = "000000.label: number of labels: expected 3 as in its ground truth, found 2";
        assert!(error.contains("out") && error.ends_with(expected), "{error}");

        folders.pair("00", "front/000000.label", &[99, 0], &[99, 0]);
        let error = folders.refusal();
        assert!(
            error.ends_with("000000.label: row 1 (from 0): expected a label, found 0 (unlabeled)"),
            "{error}"
        );

        fs::write(folders.0.path().join("out/sequences/00/front/000000.label"), [99, 0, 0]).unwrap();
        assert!(folders.refusal().contains("byte 0"), "{}", folders.refusal());
    }

    #[test]
    fn a_run_without_any_of_the_scans_is_refused() {
        let folders = Folders::new();
        folders.put("dataset/sequences/00/ground_truth/front/000000.label", &[99]);
        assert!(folders.refusal().ends_with("found no such folder"), "{}", folders.refusal());
        fs::create_dir(folders.0.path().join("out")).unwrap();
        let error = folders.refusal();
        assert!(error.ends_with("expected labels of scans that have truth, found none"), "{error}");
    }

    /// By hand: 01 has one detection in each cell, 00 no artifacts.
    #[test]
    fn the_json_has_exactly_the_names_of_the_format() {
        let folders = Folders::new();
        folders.pair("00", "front/000000.label", &[99, 99, 99, 1], &[99; 4]);
        folders.pair("01", "front/000000.label", &[99, 99, 1, 1], &[99, 1, 1, 99]);
        let text = serde_json::to_string(&folders.compare().unwrap().evaluation()).unwrap();
        let found: Value = serde_json::from_str(&text).unwrap();
        let keys = |value: &Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>();
        assert_eq!(keys(&found), ["overall", "sequences"]);
        assert_eq!(keys(&found["overall"]), ["pooled", "scan_mean"]);
        assert_eq!(keys(&found["sequences"]), ["00", "01"]);
        assert_eq!(keys(&found["sequences"]["01"]), ["pooled", "scan_mean", "scans"]);
        let third = 1.0 / 3.0;
        let balanced = json!({
            "accuracy": 0.5, "precision": 0.5, "recall": 0.5, "f1_plausible": 0.5, "f1_artifact": 0.5,
            "iou_plausible": third, "iou_artifact": third, "mean_iou": third,
            "precision_plausible": 0.5, "recall_plausible": 0.5, "mcc": 0.0,
            "tp": 1, "fp": 1, "tn": 1, "fn": 1
        });
        assert_eq!(found["sequences"]["01"]["pooled"], balanced);
        assert_eq!(found["sequences"]["01"]["scans"], json!(1));
        let one_class = json!({
            "accuracy": 0.75, "precision": 1.0, "recall": 0.75, "f1_plausible": 6.0 / 7.0, "f1_artifact": null,
            "iou_plausible": 0.75, "iou_artifact": null, "mean_iou": 0.75,
            "precision_plausible": 1.0, "recall_plausible": 0.75, "mcc": null,
            "tp": 3.0, "fp": 0.0, "tn": 0.0, "fn": 1.0
        });
        assert_eq!(found["sequences"]["00"]["scan_mean"], one_class);
        assert_eq!(found["overall"]["scan_mean"]["tp"], json!(2.0));
        assert_eq!(found["overall"]["scan_mean"]["iou_artifact"], json!(third));
    }

    /// The paper's table 4 as label files, split unevenly over scans: 87.05 % accuracy (docs/method.md, section 9).
    #[test]
    fn the_papers_confusion_matrix_comes_out_of_label_files() {
        let folders = Folders::new();
        let cells = [(430_418, 99, 10), (157_076, 99, 40), (2_432_440, 1, 1), (268_869, 1, 99)];
        let column = |pick: fn((usize, u16, u16)) -> u16| -> Vec<u16> {
            cells.iter().flat_map(|cell| std::iter::repeat_n(pick(*cell), cell.0)).collect()
        };
        let (labels, truth) = (column(|cell| cell.1), column(|cell| cell.2));
        for (number, (labels, truth)) in labels.chunks(700_001).zip(truth.chunks(700_001)).enumerate() {
            folders.pair(&format!("{:02}", number / 2), &format!("front/{number:06}.label"), labels, truth);
        }
        let evaluation = folders.compare().unwrap().evaluation();
        assert_eq!((evaluation.scans(), evaluation.sequences.len()), (5, 3));
        let pooled = evaluation.overall.pooled;
        assert_eq!(pooled.counts.total(), 3_288_803);
        let near = |found: Option<f64>, expected: f64| (found.unwrap() - expected).abs() < 5e-5;
        assert!(near(pooled.rates.accuracy, 0.8705), "{pooled:?}");
        assert!(near(pooled.rates.precision, 0.816_55) && near(pooled.rates.recall, 0.777_43), "{pooled:?}");
    }
}
