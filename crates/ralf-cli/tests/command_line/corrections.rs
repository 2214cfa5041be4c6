//! What people corrected counts in the next evaluation and tuning.

use crate::support::{Dataset, Shape, ralf};
use ralf_corrections::{Mark, Outcome, ScanEdit, ScanKey, Store, Stroke, Who};
use serde_json::Value;
use std::fs;
use std::path::Path;

const SEQUENCES: [&str; 2] = ["00", "01"];
const RADAR: &str = "radar_front";

fn labelled() -> Dataset {
    let dataset = Dataset::of(&Shape { sequences: &SEQUENCES, ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

fn who() -> Who {
    Who::named("ada")
}

fn store(out: &str) -> Store {
    Store::open(&Path::new(out).join("corrections.sqlite")).unwrap()
}

/// The ids of a `.label` file.
fn ids(file: &Path) -> Vec<u16> {
    let bytes = fs::read(file).unwrap();
    bytes.as_chunks::<4>().0.iter().map(|[low, high, ..]| u16::from_le_bytes([*low, *high])).collect()
}

/// Marks the front radar's scans as reviewed, as if the machine had said what is true, and takes the truth away.
fn review_everything(dataset: &Dataset) {
    let mut store = store(&dataset.out);
    for sequence in SEQUENCES {
        let truth = Path::new(&dataset.path).join("sequences").join(sequence).join("ground_truth");
        for scan in 0..8 {
            let machine = ids(&truth.join(RADAR).join(format!("{scan:06}.label")));
            let key = ScanKey { sequence: sequence.into(), radar: RADAR.into(), scan };
            let mark = Mark { key, content: None, base: 0, machine, reviewed: true };
            assert!(matches!(store.mark(&mark, &who()).unwrap(), Outcome::Done(_)));
        }
        fs::remove_dir_all(&truth).unwrap();
    }
}

fn evaluation<const N: usize>(arguments: [&str; N]) -> Value {
    ralf(arguments).exits(0).says(["corrected detections"]).json()["overall"]["pooled"].clone()
}

#[test]
fn a_correction_stands_above_the_datasets_truth() {
    let dataset = labelled();
    let asked = ["evaluate", &dataset.out, "--truth", &dataset.path, "--json"];
    let before = ralf(asked).exits(0).says_nothing().json()["overall"]["pooled"].clone();
    let machine = ids(&Path::new(&dataset.out).join("sequences/00").join(RADAR).join("000000.label"));
    let artifact = machine.iter().position(|id| *id == 1).unwrap() as u32;
    let detections = machine.len() as u32;
    let points = vec![artifact];
    let edit = ScanEdit { radar: RADAR.into(), scan: 0, detections, content: None, base: 0, points };
    let stroke =
        Stroke { tool: "click".into(), label: Some(10), scans: vec![edit], ..Stroke::of_sequence("00") };
    store(&dataset.out).apply(&stroke, &who()).unwrap();
    let after = evaluation(asked);
    // The machine says artifact, the person a car.
    let number = |metrics: &Value, name: &str| metrics[name].as_u64().unwrap();
    assert_eq!(number(&after, "fn"), number(&before, "fn") + 1);
    assert_eq!(
        number(&after, "tn") + number(&after, "fp") + 1,
        number(&before, "tn") + number(&before, "fp")
    );
    // Another run is judged by the same corrections where these are named.
    let other = format!("{}-other", dataset.out);
    ralf(["label", &dataset.path, "-o", &other]).exits(0);
    let named = ["evaluate", &other, "--truth", &dataset.path, "--corrections", &dataset.out, "--json"];
    assert_eq!(evaluation(named), after);
    let none = ["evaluate", &dataset.out, "--truth", &dataset.path, "--corrections", &other];
    ralf(none).exits(1).says(["corrections.sqlite: expected corrections, found none"]);
}

#[test]
fn corrections_are_enough_to_evaluate_and_to_tune() {
    let dataset = labelled();
    review_everything(&dataset);
    let found = evaluation(["evaluate", &dataset.out, "--truth", &dataset.path, "--json"]);
    assert!(found["accuracy"].as_f64().unwrap() > 0.5 && found["tp"].as_u64().unwrap() > 0, "{found}");
    let file = format!("{}.toml", dataset.out);
    let tune = |more: &[&str]| {
        let asked =
            ["tune", &dataset.path, "-o", &file, "--train", "00", "--test", "01", "--trials", "3", "-q"];
        let mut program = crate::support::program();
        crate::support::Ran::of(&program.args(asked).args(more).output().unwrap())
    };
    tune(&[]).exits(1).says(["expected files of corrected labels, found none"]);
    tune(&["--corrections", &dataset.out]).exits(0).says(["16 reviewed scans are merged into the truth"]);
    assert!(fs::read_to_string(&file).unwrap().contains("--corrections"));
}

#[test]
fn labelling_again_keeps_what_people_said() {
    let dataset = labelled();
    review_everything(&dataset);
    let file = Path::new(&dataset.out).join("corrections.sqlite");
    let before = fs::read(&file).unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--set", "fusion.alpha=1.0"]).exits(0);
    assert_eq!(fs::read(&file).unwrap(), before);
}
