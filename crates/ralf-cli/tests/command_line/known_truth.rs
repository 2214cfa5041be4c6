//! Data sets that say themselves what is true of their detections: from a first look to a report, without label files.

use crate::support::{radar_ghost, radar_scenes, ralf, without_timings};
use std::fs;

#[test]
fn ghosts_are_labelled_evaluated_and_reported() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out, page] = ["ghosts", "out", "report.html"].map(|name| folder.path().join(name));
    radar_ghost::write_dataset(&data);
    let [data, out, page] = [&data, &out, &page].map(|path| path.to_str().unwrap());
    ralf(["inspect", data]).exits(0).prints(["scenario-01_sequence-01_ped_test", "left", "lidar"]);
    ralf(["label", data, "-o", out, "--jobs", "2"]).exits(0);
    let scores = ralf(["evaluate", out, "--truth", data, "--json"]).exits(0).json();
    let counts = &scores["overall"]["pooled"];
    let total: f64 = ["tp", "fp", "tn", "fn"].iter().map(|name| counts[name].as_f64().unwrap()).sum();
    // Of eight detections in each of ten scans two are real, one is a ghost and one noise; of the others nothing is said.
    assert_eq!(total, 40.0, "{scores}");
    ralf(["report", data, out, "-o", page]).exits(0);
    let html = fs::read_to_string(page).unwrap();
    assert!(html.contains("mirror") && html.contains("noise"));
    // The same numbers from the own layout.
    let own = folder.path().join("own");
    let own = own.to_str().unwrap();
    ralf(["convert", data, "-o", own]).exits(0);
    let converted = ralf(["evaluate", out, "--truth", own, "--json"]).exits(0).json();
    assert_eq!(converted, scores);
}

#[test]
fn without_a_lidar_tracking_labels_and_says_that_it_is_alone() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out] = ["scenes", "out"].map(|name| folder.path().join(name));
    radar_scenes::write_dataset(&data);
    let [data, out] = [&data, &out].map(|path| path.to_str().unwrap());
    ralf(["inspect", data]).exits(0).prints(["no LiDAR"]);
    ralf(["label", data, "-o", out]).exits(0);
    let scores = ralf(["evaluate", out, "--truth", data, "--json"]).exits(0).json();
    let counts = &scores["overall"]["pooled"];
    assert_eq!(
        counts["tp"].as_f64().unwrap() + counts["fn"].as_f64().unwrap(),
        7.0,
        "the car in seven scans"
    );
}

#[test]
fn a_sequence_that_lost_what_tells_its_scans_is_named_as_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out, own] = ["scenes", "out", "own"].map(|name| folder.path().join(name));
    radar_scenes::write_dataset(&data);
    let sequence = |number: u32| data.join(format!("data/sequence_{number}"));
    radar_scenes::write_sequence(&sequence(2), &radar_scenes::sequence(false));
    radar_scenes::write_sequence(&sequence(3), &radar_scenes::sequence(false));
    fs::remove_file(sequence(2).join("radar_data.h5")).unwrap();
    fs::remove_file(sequence(3).join("scenes.json")).unwrap();
    let [data, out, own] = [&data, &out, &own].map(|path| path.to_str().unwrap());
    let told = [
        "left out: 1 of 3 sequences, for radar_data.h5 is missing: sequence_2",
        "left out: 1 of 3 sequences, for scenes.json is missing: sequence_3",
    ];
    ralf(["inspect", data]).exits(3).says(told);
    ralf(["label", data, "-o", out]).exits(3).says(told);
    ralf(["convert", data, "-o", own]).exits(3).says(told);
    let chosen = |name| ralf(["inspect", data, "--sequence", name]);
    assert!(!chosen("sequence_1").exits(0).stderr.contains("left out"));
    chosen("sequence_2")
        .exits(1)
        .ends_with_error(["sequence sequence_2: expected `radar_data.h5`, found none"]);
}

#[test]
fn a_damaged_sequence_is_named_and_costs_the_others_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let [data, out] = ["scenes", "out"].map(|name| folder.path().join(name));
    radar_scenes::write_dataset(&data);
    let damaged = data.join("data/sequence_2");
    radar_scenes::write_sequence(&damaged, &radar_scenes::sequence(false));
    fs::write(damaged.join("scenes.json"), "{").unwrap();
    let [data, out] = [&data, &out].map(|path| path.to_str().unwrap());
    let told = ["left out: ", "sequence_2: ", "scenes.json: line 1"];
    ralf(["inspect", data]).exits(3).says(told);
    ralf(["label", data, "-o", out]).exits(3).says(told);
    let chosen = |name| ralf(["inspect", data, "--sequence", name]);
    assert!(!chosen("sequence_1").exits(0).stderr.contains("left out"));
    chosen("sequence_2").exits(1).ends_with_error(["scenes.json: line 1"]);
    // Where many recordings are labelled, too.
    let many = folder.path().join("many");
    let many = many.to_str().unwrap();
    ralf(["cluster", "plan", "-q", data, "-o", many]).exits(3).prints(["1"]).says(told);
    ralf(["cluster", "label", many, "--task", "0"]).exits(0).says_nothing();
    ralf(["cluster", "assemble", "-q", many]).exits(3).says(told).prints(["1 of 1 recordings"]);
    let mut assembled = without_timings(format!("{many}/scenes"));
    assert!(assembled.remove("plan.json").is_some());
    assert!(assembled == without_timings(out));
}

#[test]
fn a_task_of_a_sequence_that_was_damaged_since_it_was_planned_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let [data, many] = ["scenes", "many"].map(|name| folder.path().join(name));
    radar_scenes::write_dataset(&data);
    let second = data.join("data/sequence_2");
    radar_scenes::write_sequence(&second, &radar_scenes::sequence(false));
    let [data, many] = [&data, &many].map(|path| path.to_str().unwrap());
    ralf(["cluster", "plan", "-q", data, "-o", many]).exits(0).prints(["2"]);
    fs::write(second.join("scenes.json"), "{").unwrap();
    let label = |task| ralf(["cluster", "label", many, "--task", task]);
    label("0").exits(0).says_nothing();
    label("1").exits(1).ends_with_error(["sequence sequence_2: ", "scenes.json: line 1"]);
}

#[test]
fn a_damaged_sequence_is_left_out_of_what_is_learned() {
    let folder = tempfile::tempdir().unwrap();
    let [data, model] = ["scenes", "model"].map(|name| folder.path().join(name));
    radar_scenes::write_dataset(&data);
    let sequence = |number: u32| data.join(format!("data/sequence_{number}"));
    for number in 1..=3 {
        radar_scenes::write_sequence(&sequence(number), &radar_scenes::sequence(true));
    }
    fs::write(sequence(2).join("scenes.json"), "{").unwrap();
    let [data, model] = [&data, &model].map(|path| path.to_str().unwrap());
    ralf(["learn", data, "-o", model, "--rounds", "2", "--leaves", "2", "--no-neighbours", "-q"])
        .exits(3)
        .says(["left out: sequence_2: ", "scenes.json: line 1"])
        .prints(["sequence_1", "sequence_3"]);
}
