//! `ralf evaluate`, with ground truth and without.

use crate::support::{Dataset, Shape, nuscenes, ralf, rows};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

fn labelled(shape: &Shape) -> Dataset {
    let dataset = Dataset::of(shape);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

fn keys(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

#[test]
fn json_has_exactly_the_keys_of_the_contract() {
    let dataset = labelled(&Shape { sequences: &["00", "01"], ..Shape::default() });
    let found = ralf(["evaluate", &dataset.out, "--truth", &dataset.path, "--json"]).exits(0).json();
    assert_eq!(keys(&found), ["overall", "plausibility", "sequences"]);
    assert_eq!(keys(&found["plausibility"]), ["average_precision", "calibration_error"]);
    assert_eq!(keys(&found["overall"]), ["pooled", "scan_mean"]);
    assert_eq!(keys(&found["sequences"]), ["00", "01"]);
    assert_eq!(keys(&found["sequences"]["01"]), ["pooled", "scan_mean", "scans"]);
    assert_eq!(found["sequences"]["01"]["scans"], json!(16));
    let metrics = [
        "accuracy",
        "f1_artifact",
        "f1_plausible",
        "fn",
        "fp",
        "iou_artifact",
        "iou_plausible",
        "mcc",
        "mean_iou",
        "precision",
        "precision_plausible",
        "recall",
        "recall_plausible",
        "tn",
        "tp",
    ];
    for scores in [&found["overall"], &found["sequences"]["00"]] {
        assert_eq!([keys(&scores["pooled"]), keys(&scores["scan_mean"])], [metrics, metrics]);
    }
}

/// Worked out anew from the table and the truth.
#[test]
fn what_plausibilities_are_worth_is_told() {
    let dataset = labelled(&Shape::default());
    let asked = ["evaluate", &dataset.out, "--truth", &dataset.path];
    let found = ralf(["evaluate", &dataset.out, "--truth", &dataset.path, "--json"]).exits(0).json();
    let mut seen: Vec<(f64, bool, bool)> = Vec::new();
    for row in rows(dataset.result("plausibility.parquet")) {
        let (scan, index) = (row.whole("scan").unwrap(), row.whole("point").unwrap() as usize);
        let truth = fs::read(dataset.file(&format!("ground_truth/{}/{scan:06}.label", row.radar()))).unwrap();
        let flags = row.whole("flags").unwrap() as u16;
        let never = flags & (ralf::label::flag::GROUND | ralf::label::flag::UNOBSERVED) != 0;
        seen.push((row.decimal("w").unwrap(), never, truth[4 * index] != 1));
    }
    let plausible = seen.iter().filter(|(_, _, plausible)| *plausible).count() as f64;
    let mut sum = 0.0;
    for (w, _, _) in seen.iter().filter(|(_, never, plausible)| *plausible && !never) {
        let passing = |found: &&(f64, bool, bool)| !found.1 && found.0 >= *w;
        let right = seen.iter().filter(passing).filter(|(_, _, plausible)| *plausible).count();
        sum += right as f64 / seen.iter().filter(passing).count() as f64;
    }
    let told = found["plausibility"]["average_precision"].as_f64().unwrap();
    assert!((told - sum / plausible).abs() < 1e-9 && plausible > 0.0, "{told} {}", sum / plausible);
    let error = found["plausibility"]["calibration_error"].as_f64().unwrap();
    ralf(asked)
        .exits(0)
        .prints([&format!("average precision {told:.3}, calibration error (ECE, 15 cells) {error:.3}")]);
    // Labels that others have made have no plausibility.
    fs::remove_file(format!("{}/run.json", dataset.out)).unwrap();
    let without = ralf(["evaluate", &dataset.out, "--truth", &dataset.path, "--json"]).exits(0).json();
    assert_eq!(keys(&without), ["overall", "sequences"]);
    assert_eq!(without["overall"], found["overall"]);
}

#[test]
fn sequences_and_radars_without_labels_are_named_once() {
    let dataset = Dataset::of(&Shape { sequences: &["00", "01", "02"], ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", "01"]).exits(0);
    let ran = ralf(["evaluate", &dataset.out, "--truth", &dataset.path]).exits(3);
    assert_eq!(ran.stderr, "sequence 00 has no labels: left out\nsequence 02 has no labels: left out\n");
}

#[test]
fn people_see_the_papers_table() {
    let dataset = labelled(&Shape::default());
    let ran = ralf(["evaluate", &dataset.out, "--truth", &dataset.path, "--scans"]).exits(0).says_nothing();
    ran.prints([
        "Mean over scans",
        "mean IoU",
        "truly plausible",
        "labelled artifact",
        "00/radar_left/000007",
    ]);
}

#[test]
fn a_scan_without_labels_is_named() {
    let dataset = Dataset::new();
    dataset.cut("radar_front/000003.bin", 1);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(3);
    let ran = ralf(["evaluate", &dataset.out, "--truth", &dataset.path, "--json"]).exits(3);
    let ran = ran.says(["radar_front/000003.label"]);
    assert_eq!(ran.json()["sequences"]["00"]["scans"], json!(15));
}

#[test]
fn truth_of_another_size_is_refused() {
    let dataset = labelled(&Shape::default());
    dataset.cut("ground_truth/radar_front/000003.label", 4);
    let ran = ralf(["evaluate", &dataset.out, "--truth", &dataset.path]).exits(1).prints_nothing();
    ran.says(["radar_front/000003.label", "25", "26"]);
}

#[test]
fn truth_that_is_not_there_is_named() {
    let dataset = labelled(&Shape { scans: 1, ..Shape::default() });
    let nowhere = dataset.beside("nowhere");
    ralf(["evaluate", &dataset.out, "--truth", &nowhere]).exits(1).prints_nothing().says([&nowhere]);
    let judged = ralf(["evaluate", &nowhere, "--truth", &dataset.path]).exits(1).prints_nothing();
    judged.ends_with_error([&nowhere, "found no such folder"]);
    let told = [&nowhere, "run.json", "found no such folder"];
    ralf(["evaluate", &nowhere]).exits(1).prints_nothing().ends_with_error(told);
    // Labels that others have made have no record.
    let record = format!("{}/run.json", dataset.out);
    fs::remove_file(record).unwrap();
    ralf(["evaluate", &dataset.out, "--truth", &dataset.path]).exits(0);
}

#[test]
fn a_recording_of_a_format_without_truth_is_told_so() {
    let place = tempfile::tempdir().unwrap();
    let [recording, out] =
        ["recording", "out"].map(|name| place.path().join(name).to_str().unwrap().to_owned());
    nuscenes(Path::new(&recording));
    ralf(["label", &recording, "-o", &out]).exits(0);
    let told =
        [&recording, "truth: expected corrected labels", "a recording of the format nuscenes, without truth"];
    ralf(["evaluate", &out, "--truth", &recording]).exits(1).prints_nothing().ends_with_error(told);
}

/// Worked out anew from the table.
#[test]
fn without_truth_it_tells_how_far_apart_the_classes_are() {
    let dataset = labelled(&Shape { sequences: &["00", "01"], ..Shape::default() });
    let found = ralf(["evaluate", &dataset.out, "--json"]).exits(0).says_nothing().json();
    assert_eq!(keys(&found), ["overall", "radars", "sequences"]);
    assert_eq!(keys(&found["radars"]), ["radar_front", "radar_left"]);
    assert_eq!(keys(&found["sequences"]), ["00", "01"]);
    let rows = rows(dataset.result("plausibility.parquet"));
    let of = |radar: &str, label: i64| -> Vec<f64> {
        let of_class = rows.iter().filter(|row| row.radar() == radar && row.whole("label") == Some(label));
        of_class.map(|row| row.decimal("w").unwrap()).collect()
    };
    for radar in ["radar_front", "radar_left"] {
        let [artifact, plausible] = [0, 1].map(|label| of(radar, label));
        let mean = |w: &[f64]| w.iter().sum::<f64>() / w.len() as f64;
        let values = &found["radars"][radar];
        // Both sequences are the same.
        assert_eq!(values["plausible"], json!(2 * plausible.len()));
        assert_eq!(values["artifact"], json!(2 * artifact.len()));
        assert_eq!(values["detections"], json!(2 * (plausible.len() + artifact.len())));
        let near = |key: &str, expected: f64| (values[key].as_f64().unwrap() - expected).abs() < 1e-9;
        assert!(near("distinctiveness", mean(&plausible) - mean(&artifact)), "{values}");
        assert!(near("plausible_share", plausible.len() as f64 / (plausible.len() + artifact.len()) as f64));
    }
    assert_eq!(found["overall"]["detections"], json!(2 * 8 * (26 + 20)));
    assert_eq!(found["sequences"]["00"], found["sequences"]["01"]);
    let text = ralf(["evaluate", &dataset.out]).exits(0).says_nothing();
    text.prints(["distinctiveness", "plausible", "radar_left", "sequence 01", "overall"]);
}

#[test]
fn a_class_that_is_empty_has_no_distinctiveness() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out, "--set", "fusion.threshold=1"]).exits(0);
    let found = ralf(["evaluate", &dataset.out, "--json"]).exits(0).json();
    assert_eq!(found["overall"]["distinctiveness"], Value::Null);
    assert_eq!(found["overall"]["plausible_share"], json!(0.0));
    ralf(["evaluate", &dataset.out]).exits(0).prints(["-"]);
}

#[test]
fn rows_per_scan_need_truth() {
    let dataset = labelled(&Shape { scans: 1, ..Shape::default() });
    ralf(["evaluate", &dataset.out, "--scans"]).exits(2).prints_nothing().says(["--truth"]);
}

/// A sequence that can't be opened says nothing of whether the others are what was labelled.
#[test]
fn a_recording_that_cannot_be_opened_is_not_taken_for_what_was_labelled() {
    let dataset = labelled(&Shape { scans: 2, sequences: &["00", "01", "02"], ..Shape::default() });
    let evaluate = || ralf(["evaluate", &dataset.out, "--truth", &dataset.path]);
    let toml = |sequence: &str| format!("{}/sequences/{sequence}/sequence.toml", dataset.path);
    evaluate().exits(0);
    let whole = fs::read_to_string(toml("01")).unwrap();
    fs::write(toml("01"), "format =").unwrap();
    evaluate().exits(1).prints_nothing().ends_with_error(["01/sequence.toml"]);
    fs::remove_file(toml("01")).unwrap();
    evaluate().exits(1).prints_nothing().ends_with_error(["01/sequence.toml"]);
    // Truth alone is enough.
    for sequence in ["00", "01", "02"] {
        for file in ["sequence.toml", "odometry.csv"] {
            fs::remove_file(format!("{}/sequences/{sequence}/{file}", dataset.path)).ok();
        }
    }
    evaluate().exits(0);
    // What was never labelled may be damaged.
    let part = labelled(&Shape { scans: 2, ..Shape::default() });
    let other = format!("{}/sequences/01", part.path);
    fs::create_dir_all(&other).unwrap();
    fs::write(format!("{other}/sequence.toml"), whole + "format =").unwrap();
    ralf(["evaluate", &part.out, "--truth", &part.path]).exits(0);
    part.cut("radar_front/000001.bin", 20);
    let told = ["radar_front/000001.bin: expected what was labelled"];
    ralf(["evaluate", &part.out, "--truth", &part.path]).exits(1).prints_nothing().ends_with_error(told);
}
