//! Sequences that are labelled one after the other, into the same folder.

use crate::support::{Dataset, Shape, ralf, tree, without_timings};
use serde_json::Value;
use std::fs;

const OTHER: &str = "fusion.threshold=0.9";

fn two() -> Dataset {
    Dataset::of(&Shape { scans: 4, sequences: &["00", "01"], ..Shape::default() })
}

/// The names of the sequences that `run.json` tells of.
fn recorded(dataset: &Dataset) -> Vec<String> {
    let record: Value =
        serde_json::from_slice(&fs::read(format!("{}/run.json", dataset.out)).unwrap()).unwrap();
    let names = record["sequences"].as_array().unwrap().iter();
    names.map(|sequence| sequence["name"].as_str().unwrap().to_owned()).collect()
}

#[test]
fn one_after_the_other_is_the_same_as_all_at_once() {
    for order in [["00", "01"], ["01", "00"]] {
        let dataset = two();
        let whole = dataset.beside("whole");
        ralf(["label", &dataset.path, "-o", &whole, "--jobs", "1"]).exits(0);
        for sequence in order {
            ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", sequence, "--jobs", "3"])
                .exits(0)
                .says_nothing();
        }
        assert_eq!(recorded(&dataset), ["00", "01"]);
        assert!(without_timings(&dataset.out) == without_timings(&whole));
        let before = tree(&dataset.out);
        ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says(["nothing to do"]);
        assert!(tree(&dataset.out) == before);
    }
}

#[test]
fn only_what_is_not_labelled_yet_is_labelled() {
    let dataset = two();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", "00"]).exits(0);
    let table = dataset.result("plausibility.parquet");
    let written = fs::metadata(&table).unwrap().modified().unwrap();
    let ran = ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    ran.prints(["00", "01", "\n8 scans, "]);
    assert_eq!(fs::metadata(&table).unwrap().modified().unwrap(), written);
}

#[test]
fn other_settings_remove_the_other_sequences_and_say_so() {
    let dataset = two();
    let fresh = dataset.beside("fresh");
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let notes = dataset.result("notes.txt");
    fs::write(&notes, "mine").unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", "01", "--set", OTHER])
        .exits(0)
        .says(["removed", "other settings: 00\n"]);
    // What people put there stays.
    fs::remove_file(&notes).unwrap();
    fs::remove_dir(notes.parent().unwrap()).unwrap();
    ralf(["label", &dataset.path, "-o", &fresh, "--sequence", "01", "--set", OTHER]).exits(0);
    assert!(without_timings(&dataset.out) == without_timings(&fresh));
}

#[test]
fn a_sequence_that_changed_leaves_the_others_alone() {
    let dataset = two();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset.edit("sequence.toml", "sigma_azimuth_deg = 0.6", "sigma_azimuth_deg = 0.7");
    let whole = dataset.beside("whole");
    ralf(["label", &dataset.path, "-o", &whole]).exits(0);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing().prints(["\n8 scans, "]);
    assert!(without_timings(&dataset.out) == without_timings(&whole));
}

#[test]
fn only_scans_of_what_is_asked_for_count_as_not_labelled() {
    let dataset = two();
    dataset.cut("radar_front/000003.bin", 1);
    let label = |sequence| ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", sequence]);
    assert_eq!(label("00").exits(3).not_labelled().len(), 1);
    label("01").exits(0).says_nothing();
    label("01").exits(0).says(["nothing to do"]);
    assert_eq!(label("00").exits(3).says(["nothing to do"]).not_labelled().len(), 1);
}
