//! A run that was killed goes on where it stopped; another run replaces all of it.

use crate::support::{Dataset, Shape, program, ralf, tree, without_timings};
use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Files below a folder that end so.
fn count(folder: impl AsRef<Path>, end: &str) -> usize {
    if folder.as_ref().exists() { tree(folder).keys().filter(|name| name.ends_with(end)).count() } else { 0 }
}

/// Starts a run and kills it as soon as some scans are labelled.
fn kill_midway(dataset: &Dataset) {
    let mut run =
        program().args(["label", &dataset.path, "-o", &dataset.out, "--jobs", "1"]).spawn().unwrap();
    let begun = Instant::now();
    while count(Path::new(&dataset.out).join(".ralf-run"), ".rows") < 10 {
        assert!(run.try_wait().unwrap().is_none(), "it ended before it could be killed");
        assert!(begun.elapsed() < Duration::from_secs(60), "it labels nothing");
        sleep(Duration::from_millis(2));
    }
    // SIGKILL on Unix.
    run.kill().unwrap();
    assert!(!run.wait().unwrap().success());
    assert!(!Path::new(&dataset.out).join("run.json").exists());
}

#[test]
fn a_run_that_was_killed_goes_on_and_ends_the_same() {
    let dataset = Dataset::of(&Shape { scans: 60, ..Shape::default() });
    kill_midway(&dataset);
    let kept = dataset.result("radar_front/000000.label");
    let written = fs::metadata(&kept).unwrap().modified().unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert_eq!(fs::metadata(&kept).unwrap().modified().unwrap(), written, "it was labelled again");
    let whole = dataset.beside("whole");
    ralf(["label", &dataset.path, "-o", &whole]).exits(0);
    assert!(without_timings(&dataset.out) == without_timings(&whole));
}

#[test]
fn what_a_power_cut_spoiled_is_made_again() {
    let dataset = Dataset::of(&Shape { scans: 60, ..Shape::default() });
    let whole = dataset.beside("whole");
    ralf(["label", &dataset.path, "-o", &whole]).exits(0);
    kill_midway(&dataset);
    let unfinished = Path::new(&dataset.out).join(".ralf-run");
    let kept: Vec<_> = tree(&unfinished).into_keys().filter(|name| name.ends_with(".rows")).collect();
    fs::write(unfinished.join(&kept[0]), "").unwrap();
    // FINGERPRINT/00/radar_front/000001.rows
    let label = kept[1].split_once('/').unwrap().1.replace(".rows", ".label");
    fs::write(Path::new(&dataset.out).join("sequences").join(label), "").unwrap();
    fs::write(unfinished.join(&kept[0]).ancestors().nth(2).unwrap().with_extension("json"), "{").unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert!(without_timings(&dataset.out) == without_timings(&whole));
    fs::write(format!("{}/run.json", dataset.out), "{").unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert!(without_timings(&dataset.out) == without_timings(&whole));
}

#[test]
fn a_sequence_that_was_finished_before_the_kill_is_kept() {
    let dataset = Dataset::of(&Shape { scans: 4, sequences: &["00", "01"], ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let whole = without_timings(&dataset.out);
    // What is on disk between the last sequence and the record.
    let record: serde_json::Value =
        serde_json::from_slice(&fs::read(format!("{}/run.json", dataset.out)).unwrap()).unwrap();
    let unfinished = format!("{}/.ralf-run/{}", dataset.out, record["fingerprint"].as_str().unwrap());
    fs::create_dir_all(&unfinished).unwrap();
    for sequence in record["sequences"].as_array().unwrap() {
        let file = format!("{unfinished}/{}.json", sequence["name"].as_str().unwrap());
        fs::write(file, sequence.to_string()).unwrap();
    }
    fs::remove_file(format!("{}/run.json", dataset.out)).unwrap();
    let table = dataset.result("plausibility.parquet");
    let written = fs::metadata(&table).unwrap().modified().unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert_eq!(fs::metadata(&table).unwrap().modified().unwrap(), written);
    assert!(without_timings(&dataset.out) == whole);
}

#[test]
fn a_lost_record_is_made_again() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let whole = without_timings(&dataset.out);
    fs::remove_file(format!("{}/run.json", dataset.out)).unwrap();
    fs::create_dir_all(format!("{}/.ralf-run/of-another-run/00", dataset.out)).unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert!(without_timings(&dataset.out) == whole);
}

#[test]
fn other_settings_replace_everything() {
    let dataset = Dataset::new();
    let fresh = dataset.beside("fresh");
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    for out in [&dataset.out, &fresh] {
        ralf(["label", &dataset.path, "-o", out, "--set", "fusion.threshold=0.9"]).exits(0).says_nothing();
    }
    assert!(without_timings(&dataset.out) == without_timings(&fresh));
}

#[test]
fn other_settings_replace_what_a_killed_run_left() {
    let dataset = Dataset::of(&Shape { scans: 60, sequences: &["00", "01"], ..Shape::default() });
    kill_midway(&dataset);
    // A kill may fall into the writing of a file.
    fs::write(dataset.result("radar_front/000000.label.part"), "half").unwrap();
    fs::write(dataset.result("plausibility.parquet.part"), "half").unwrap();
    let fresh = dataset.beside("fresh");
    for out in [&dataset.out, &fresh] {
        ralf(["label", &dataset.path, "-o", out, "--sequence", "01"]).exits(0).says_nothing();
    }
    assert!(without_timings(&dataset.out) == without_timings(&fresh));
}

#[test]
fn a_scan_that_can_not_be_labelled_any_more_keeps_no_label() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset.cut("radar_front/000003.bin", 1);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(3);
    assert!(!dataset.result("radar_front/000003.label").exists());
    assert!(dataset.result("radar_front/000002.label").exists());
}

#[test]
fn a_sequence_that_is_not_asked_for_any_more_leaves_nothing() {
    let dataset = Dataset::of(&Shape { scans: 2, sequences: &["00", "01"], ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let notes = dataset.result("notes.txt");
    fs::write(&notes, "mine").unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", "01"]).exits(0);
    let left: Vec<_> = tree(&dataset.out).into_keys().filter(|name| name.contains("/00")).collect();
    // What people put there stays.
    let of_one = ["000000.label", "000001.label"];
    let expected: Vec<String> = ["sequences/00".to_owned(), "sequences/00/notes.txt".to_owned()]
        .into_iter()
        .chain(
            ["radar_front", "radar_left"]
                .iter()
                .flat_map(|r| of_one.map(|f| format!("sequences/01/{r}/{f}"))),
        )
        .collect();
    assert_eq!(left, expected);
}
