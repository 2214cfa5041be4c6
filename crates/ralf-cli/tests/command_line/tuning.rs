//! `ralf tune`: what it reports is what labelling with its settings reaches, and nothing it is judged on is trained on.

use crate::support::{Dataset, Ran, Shape, program, ralf};
use serde_json::{Value, json};
use std::fs;

fn two_sequences() -> Dataset {
    Dataset::of(&Shape { sequences: &["00", "01"], ..Shape::default() })
}

fn tune(dataset: &Dataset, file: &str, jobs: &str) -> Value {
    ralf([
        "tune",
        &dataset.path,
        "-o",
        file,
        "--train",
        "00",
        "--test",
        "01",
        "--trials",
        "60",
        "--seed",
        "3",
        "--jobs",
        jobs,
        "--json",
    ])
    .exits(0)
    .says_nothing()
    .json()
}

/// What `ralf evaluate` finds in the labels of one sequence.
fn labelled(dataset: &Dataset, sequence: &str, settings: &[&str]) -> Value {
    let out = dataset.beside(&format!("out-{sequence}-{}", settings.len()));
    let arguments = ["label", &dataset.path, "-o", &out, "--sequence", sequence];
    let label = crate::support::program().args(arguments).args(settings).output().unwrap();
    assert!(label.status.success());
    // The other sequence has truth and no labels.
    let scores = ralf(["evaluate", &out, "--truth", &dataset.path, "--json"]).exits(3).json();
    scores["sequences"][sequence].clone()
}

#[test]
fn the_file_it_writes_labels_as_well_as_it_reports() {
    let dataset = two_sequences();
    let file = dataset.beside("settings/ralf.toml");
    let report = tune(&dataset, &file, "1");
    let with_file = labelled(&dataset, "01", &["--config", &file]);
    let without = labelled(&dataset, "01", &[]);
    for (part, found) in [("tuned", &with_file), ("base", &without)] {
        assert_eq!(report["test"][part]["pooled"], found["pooled"], "{part}");
        assert_eq!(report["test"][part]["scan_mean"], found["scan_mean"], "{part}");
    }
    assert_eq!(report["test"]["scans"], with_file["scans"]);
    let on_train = labelled(&dataset, "00", &["--config", &file]);
    assert_eq!(report["score"], on_train["pooled"]["f1_plausible"]);
    assert!(report["score"].as_f64() >= report["train"]["base"]["pooled"]["f1_plausible"].as_f64());
    assert_eq!(report["cross_validation"], json!(null));
}

#[test]
fn a_sequence_counts_once_and_no_recording_is_written_over() {
    let (dataset, other) = (two_sequences(), Dataset::new());
    let file = dataset.beside("found.toml");
    for (train, test) in [("00,00", "01"), ("00", "01,01")] {
        ralf(["tune", &dataset.path, "-o", &file, "--train", train, "--test", test])
            .exits(2)
            .ends_with_error(["expected each sequence once, found 0", "twice"]);
    }
    let sensors = other.file("sequence.toml");
    let before = fs::read(&sensors).unwrap();
    ralf([
        "tune",
        &dataset.path,
        "-o",
        sensors.to_str().unwrap(),
        "--train",
        "00",
        "--test",
        "01",
        "--trials",
        "1",
    ])
    .exits(2)
    .ends_with_error(["--output: expected a place where nothing is lost"]);
    assert!(fs::read(&sensors).unwrap() == before);
}

#[test]
fn a_seed_gives_the_same_bytes_whatever_the_number_of_jobs() {
    let dataset = two_sequences();
    let [one, other] = ["one.toml", "other.toml"].map(|name| dataset.beside(name));
    assert_eq!(tune(&dataset, &one, "1"), tune(&dataset, &other, "4"));
    let text = fs::read_to_string(&one).unwrap();
    assert_eq!(text, fs::read_to_string(&other).unwrap());
    for part in [
        "--train 00 --test 01",
        "--objective f1 --trials 60 --seed 3",
        "did not see, 01",
        "  before: accuracy ",
    ] {
        assert!(text.contains(part), "expected `{part}` in\n{text}");
    }
}

#[test]
fn cross_validation_leaves_each_sequence_out() {
    let dataset = two_sequences();
    let file = dataset.beside("ralf.toml");
    let run = |extra: &str| {
        ralf([
            "tune",
            &dataset.path,
            "-o",
            &file,
            "--train",
            "00,01",
            "--trials",
            "25",
            "--cross-validate",
            extra,
        ])
        .exits(0)
    };
    let report = run("--json").json();
    assert_eq!(report["test"], json!(null));
    let folds = report["cross_validation"].as_array().unwrap();
    assert_eq!(folds.iter().map(|fold| &fold["left_out"]).collect::<Vec<_>>(), ["00", "01"]);
    // The fold without 01 is a search on 00 alone.
    let alone = ralf([
        "tune",
        &dataset.path,
        "-o",
        &file,
        "--train",
        "00",
        "--test",
        "01",
        "--trials",
        "25",
        "--json",
    ]);
    let alone = alone.exits(0).json();
    assert_eq!(folds[1]["settings"], alone["settings"]["tuned"]);
    assert_eq!(folds[1]["tuned"], alone["test"]["tuned"]);
    run("--quiet").prints(["Setting", "tracking.scans", "Left out", "01, after", "mean ± deviation, after"]);
    assert!(fs::read_to_string(&file).unwrap().contains(" ± "));
}

#[test]
fn what_cannot_be_tuned_is_refused() {
    let dataset = two_sequences();
    let file = dataset.beside("ralf.toml");
    let refused = |train: &str, test: &str, objective: &str, code: i32| {
        let ran = ralf([
            "tune",
            &dataset.path,
            "-o",
            &file,
            "--train",
            train,
            "--test",
            test,
            "--objective",
            objective,
        ]);
        assert!(!fs::exists(&file).unwrap());
        ran.exits(code).prints_nothing()
    };
    refused("00", "00", "f1", 2).says(["--train and --test both name 00"]);
    refused("00", "07", "f1", 1).says(["no sequence `07`", "which holds 00, 01"]);
    refused("00", "01", "f2", 2).says(["recall@precision=P", "found `f2`"]);
    refused("00", "01", "recall@precision=80", 2).says(["found `recall@precision=80`"]);
    fs::remove_dir_all(dataset.file("ground_truth")).unwrap();
    refused("00", "01", "f1", 1).says(["sequence 00: expected ground truth"]);
    ralf(["tune", &dataset.path, "-o", &file, "--train", "00"]).exits(2).says(["--test"]);
    ralf(["tune", &dataset.path, "-o", &file, "--train", "00", "--cross-validate"])
        .exits(2)
        .says(["two sequences"]);
}

#[test]
fn scans_that_cannot_be_read_are_named_and_left_out() {
    let dataset = two_sequences();
    dataset.cut("radar_left/000002.bin", 1);
    let file = dataset.beside("ralf.toml");
    let arguments =
        ["tune", &dataset.path, "-o", &file, "--train", "00", "--test", "01", "--trials", "5", "--json"];
    let ran = ralf(arguments).exits(3).says(["left out: 00 radar_left scan 2", "000002.bin"]);
    assert_eq!(ran.json()["train"]["scans"], json!(15));
}

#[test]
fn lidar_scans_that_cannot_be_read_are_named_once() {
    let dataset = two_sequences();
    dataset.cut("lidar_top/000002.bin", 1);
    let file = dataset.beside("ralf.toml");
    let ran = ralf(["tune", &dataset.path, "-o", &file, "--train", "00", "--test", "01", "--trials", "2"]);
    let told = ran.exits(0).says(["matched without: 00 lidar_top scan 2", "000002.bin"]).stderr;
    assert_eq!(told.matches("matched without").count(), 1, "{told}");
}

#[test]
fn a_truth_of_another_size_is_named() {
    let dataset = two_sequences();
    dataset.cut("ground_truth/radar_left/000002.label", 4);
    let file = dataset.beside("ralf.toml");
    let ran = ralf(["tune", &dataset.path, "-o", &file, "--train", "00", "--test", "01"]).exits(1);
    ran.says(["000002.label", "number of labels"]);
}

#[test]
fn the_comment_repeats_the_settings_that_were_given() {
    let dataset = two_sequences();
    let file = dataset.beside("held.toml");
    let arguments =
        ["tune", &dataset.path, "-o", &file, "--train", "00", "--test", "01", "--trials", "2", "-q"];
    let given = ["--hold", "lidar.beta", "--set", "lidar.beta=0.3", "--set", "seed=4"];
    let tune = crate::support::program().args(arguments).args(given).output().unwrap();
    assert!(tune.status.success());
    let text = fs::read_to_string(&file).unwrap();
    assert!(text.contains("--hold lidar.beta --set lidar.beta=0.3 --set seed=4"), "{text}");
    assert!(text.contains("beta = 0.3\n"), "{text}");
}

#[test]
fn settings_that_somebody_has_edited_are_kept() {
    let dataset = two_sequences();
    let file = dataset.beside("ralf.toml");
    let tune =
        || ralf(["tune", &dataset.path, "-o", &file, "--train", "00", "--test", "01", "--trials", "1", "-q"]);
    tune().exits(0);
    tune().exits(0);
    let edited = fs::read_to_string(&file).unwrap().replacen("alpha", "# As we had it in May.\nalpha", 1);
    fs::write(&file, &edited).unwrap();
    let told = ["--output: ", &file, "found another text, which would be lost"];
    tune().exits(2).ends_with_error(told);
    ralf(["check", &dataset.path, "--write", &file]).exits(2).ends_with_error([
        "--write: ",
        told[1],
        told[2],
    ]);
    assert_eq!(fs::read_to_string(&file).unwrap(), edited);
    ralf(["label", &dataset.path, "-o", &dataset.out, "--config", &file]).exits(0);
    fs::remove_file(&file).unwrap();
    for _ in 0..2 {
        ralf(["check", &dataset.path, "--write", &file]).exits(0);
    }
}

#[test]
fn a_method_that_is_fitted_and_not_searched_for_is_refused_with_what_to_do_instead() {
    let dataset = two_sequences();
    let file = dataset.beside("ralf.toml");
    let learned = ["--train", "00", "--test", "01", "--set", "method=learned"];
    let [a, b, c, d, e, f] = learned;
    ralf(["tune", &dataset.path, "-o", &file, a, b, c, d, e, f]).exits(2).says(["ralf learn"]);
    ralf(["ablate", &dataset.path, a, b, c, d, e, f]).exits(2).says(["--without-group"]);
    assert!(!fs::exists(&file).unwrap());
}

#[test]
fn nothing_to_tune_and_names_that_are_empty_are_refused() {
    let dataset = two_sequences();
    let file = dataset.beside("ralf.toml");
    let tune = |train: &str, test: &str, off: &[&str]| {
        let mut command = crate::support::program();
        command.args(["tune", &dataset.path, "-o", &file, "--train", train, "--test", test, "--trials", "2"]);
        for branch in off {
            command.args(["--set", &format!("{branch}.enabled=false")]);
        }
        crate::support::Ran::of(&command.output().unwrap())
    };
    tune("00,", "01", &[]).exits(2).ends_with_error(["--train: expected names", "an empty one in `00,`"]);
    tune("00", ",01", &[]).exits(2).ends_with_error(["--test: expected names", "an empty one in `,01`"]);
    tune("00", "01", &["lidar", "camera", "tracking"])
        .exits(2)
        .ends_with_error(["expected one branch or more", "are all false"]);
    // There is no camera: all settings would be as good as any other.
    tune("00", "01", &["lidar", "tracking"]).exits(2).ends_with_error([
        "that observes something",
        "found camera.enabled without depth of any camera, and",
    ]);
    assert!(!fs::exists(&file).unwrap());
    tune("00", "01", &["camera", "tracking"]).exits(0);
}

#[test]
fn what_correcting_a_recording_warns_of_is_told() {
    let dataset = two_sequences();
    for name in ["00", "01"] {
        fs::remove_file(format!("{}/sequences/{name}/odometry.csv", dataset.path)).unwrap();
    }
    let arguments = ["--train", "00", "--test", "01", "--trials", "1"];
    for command in ["tune", "ablate"] {
        let file = dataset.beside("found.toml");
        let mut run = program();
        run.args([command, &dataset.path]).args(arguments);
        if command == "tune" {
            run.args(["-o", &file]);
        }
        Ran::of(&run.output().unwrap()).says(["warning: 00: neither odometry nor poses", "range rates"]);
    }
}
