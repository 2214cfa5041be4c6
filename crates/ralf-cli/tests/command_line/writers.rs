//! One writer for a place: real processes side by side, and one that is killed.

use crate::support::{Dataset, Ran, Shape, program, ralf, tree, without_timings};
use std::path::Path;
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

const TOLD: &str = "another run of ralf writes here";

/// A run under way that holds its place.
fn begin(arguments: &[&str], lock: &str) -> Child {
    let mut run = program().args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let begun = Instant::now();
    while !Path::new(lock).exists() {
        assert!(run.try_wait().unwrap().is_none(), "it ended before it could be seen");
        assert!(begun.elapsed() < Duration::from_secs(60), "it locks nothing");
        sleep(Duration::from_micros(200));
    }
    // The file is there a moment before it is locked.
    sleep(Duration::from_millis(5));
    run
}

fn end(run: Child) -> Ran {
    Ran::of(&run.wait_with_output().unwrap())
}

#[test]
fn the_second_label_run_is_told_and_the_first_ends_as_alone() {
    // So many scans that the first run is surely still at work when the second begins, on a busy machine, too.
    let dataset = Dataset::of(&Shape { scans: 600, ..Shape::default() });
    let lock = format!("{}/.ralf-lock", dataset.out);
    let first = begin(&["label", &dataset.path, "-o", &dataset.out, "--jobs", "1"], &lock);
    ralf(["label", &dataset.path, "-o", &dataset.out, "--set", "fusion.threshold=0.9"])
        .exits(1)
        .prints_nothing()
        .says([&dataset.out, TOLD]);
    end(first).exits(0);
    let alone = dataset.beside("alone");
    ralf(["label", &dataset.path, "-o", &alone]).exits(0);
    assert!(without_timings(&dataset.out) == without_timings(&alone), "and no lock is left");
}

/// Many at once: one of them writes at a time, and what lies there in the end is of one run.
#[test]
fn of_many_runs_with_different_settings_the_folder_is_of_one() {
    let dataset = Dataset::of(&Shape { scans: 20, ..Shape::default() });
    let thresholds = ["0.3", "0.5", "0.7", "0.9"];
    let runs: Vec<Child> = thresholds
        .iter()
        .map(|threshold| {
            let setting = format!("fusion.threshold={threshold}");
            let run = ["label", &dataset.path, "-o", &dataset.out, "--set", &setting, "--jobs", "1"];
            program().args(run).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
        })
        .collect();
    let ended: Vec<Ran> = runs.into_iter().map(end).collect();
    assert!(ended.iter().any(|ran| ran.code == Some(0)));
    for ran in ended.into_iter().filter(|ran| ran.code != Some(0)) {
        ran.exits(1).says([TOLD]);
    }
    let found = without_timings(&dataset.out);
    let fresh = |threshold: &str| {
        let out = dataset.beside(threshold);
        ralf(["label", &dataset.path, "-o", &out, "--set", &format!("fusion.threshold={threshold}")])
            .exits(0);
        without_timings(out)
    };
    assert!(thresholds.into_iter().any(|threshold| fresh(threshold) == found));
}

#[test]
fn a_killed_run_leaves_no_lock_that_holds() {
    let dataset = Dataset::of(&Shape { scans: 60, ..Shape::default() });
    let lock = format!("{}/.ralf-lock", dataset.out);
    let mut killed = begin(&["label", &dataset.path, "-o", &dataset.out, "--jobs", "1"], &lock);
    // SIGKILL on Unix.
    killed.kill().unwrap();
    killed.wait().unwrap();
    assert!(Path::new(&lock).exists());
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let alone = dataset.beside("alone");
    ralf(["label", &dataset.path, "-o", &alone]).exits(0);
    assert!(without_timings(&dataset.out) == without_timings(&alone));
}

#[test]
fn exports_and_conversions_to_one_place_do_not_mix() {
    let dataset = Dataset::of(&Shape { scans: 300, ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let (labels, copy, bag) = (dataset.beside("labels"), dataset.beside("copy"), dataset.beside("a.mcap"));
    let export = |split: &'static str, to: &str| {
        ["export", &dataset.path, &dataset.out, "--to", "npz", "-o", to, "--split", split].map(str::to_owned)
    };
    let text = |arguments: &[String]| arguments.to_vec();
    for (arguments, second, lock) in [
        (text(&export("all", &labels)), text(&export("artifact", &labels)), ".labels.lock"),
        (
            ["convert", &dataset.path, "-o", &copy].map(str::to_owned).to_vec(),
            ["convert", &dataset.path, "-o", &copy].map(str::to_owned).to_vec(),
            "copy/sequences/.00.lock",
        ),
        (
            ["convert", &dataset.path, "-o", &bag].map(str::to_owned).to_vec(),
            ["convert", &dataset.path, "-o", &bag].map(str::to_owned).to_vec(),
            ".a.mcap.lock",
        ),
    ] {
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        let first = begin(&arguments, &dataset.beside(lock));
        let codes = [Ran::of(&program().args(&second).output().unwrap()).code, end(first).code];
        assert_eq!(codes, [Some(1), Some(0)]);
        assert!(!Path::new(&dataset.beside(lock)).exists());
    }
    let alone = dataset.beside("alone");
    let arguments = export("all", &alone);
    Ran::of(&program().args(&arguments).output().unwrap()).exits(0);
    assert!(tree(labels) == tree(alone));
    let again = dataset.beside("again");
    ralf(["convert", &dataset.path, "-o", &again]).exits(0);
    assert!(tree(copy) == tree(again));
}
