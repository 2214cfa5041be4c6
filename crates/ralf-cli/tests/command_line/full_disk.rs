//! A disk that is full: nothing half-written takes a result's place, and with space the run goes on.

use crate::support::{Dataset, Ran, Shape, program, ralf, tree, without_timings};
use std::process::Command;

/// Runs `ralf` where no file may grow beyond so many KiB, which fails as on a full disk.
pub(crate) fn with_files_up_to(kib: u32, arguments: &[&str]) -> Ran {
    let script = format!("trap '' XFSZ; ulimit -f {kib}; exec \"$0\" \"$@\"");
    let mut bash = Command::new("bash");
    Ran::of(&bash.args(["-c", &script]).arg(program().get_program()).args(arguments).output().unwrap())
}

#[test]
fn a_run_says_where_it_stopped_and_goes_on_later() {
    let dataset = Dataset::new();
    let whole = dataset.beside("whole");
    ralf(["label", &dataset.path, "-o", &whole]).exits(0);
    let expected = without_timings(&whole);
    // Nothing fits, then some scans in each run, and when all are labelled not the sequence's table.
    for (kib, named) in [(0, "recording.json"), (7, ".scans"), (7, "plausibility.parquet")] {
        let run = || with_files_up_to(kib, &["label", &dataset.path, "-o", &dataset.out]);
        let runs = || (0..30).map(|_| run());
        let ran = runs().find(|ran| ran.stderr.contains(named)).unwrap();
        ran.exits(1).prints_nothing().says([named, "File too large"]);
        for (name, content) in tree(&dataset.out) {
            assert!(!name.ends_with(".part") && name != "run.json", "{name}");
            if let Some(whole) = expected.get(&name) {
                assert!(content == *whole, "{name}");
            }
        }
    }
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says_nothing();
    assert!(without_timings(&dataset.out) == expected);
}

#[test]
fn a_conversion_leaves_nothing_half_done() {
    let dataset = Dataset::new();
    let copy = dataset.beside("copy");
    with_files_up_to(4, &["convert", &dataset.path, "-o", &copy])
        .exits(1)
        .says(["lidar_top", "File too large"]);
    assert!(!std::fs::exists(&copy).unwrap());
    ralf(["convert", &dataset.path, "-o", &copy]).exits(0);
}

#[test]
fn a_picture_appears_whole_or_not_at_all() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let picture = dataset.beside("scan.png");
    let plot = ["plot", &dataset.path, &dataset.out, "--scan", "0", "-o", &picture];
    with_files_up_to(1, &plot).exits(1).says([&picture, "File too large"]);
    assert!(!std::fs::exists(&picture).unwrap());
}

#[test]
fn a_guess_of_topics_appears_whole_or_not_at_all_and_is_written_later() {
    let dataset = Dataset::new();
    let bag = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../testdata/ros/lz4.bag");
    let topics = dataset.beside("topics.toml");
    let inspect = ["inspect", bag.to_str().unwrap(), "--write-topics", &topics];
    with_files_up_to(0, &inspect).exits(1).ends_with_error([&topics, "File too large"]);
    assert!(!std::fs::exists(&topics).unwrap());
    ralf(inspect).exits(0);
}

#[test]
fn what_was_found_is_printed_before_its_file_is_written() {
    let dataset = Dataset::of(&Shape { scans: 3, sequences: &["00", "01"], ..Shape::default() });
    let file = dataset.beside("found");
    let tune = ["tune", &dataset.path, "-o", &file, "--train", "00", "--test", "01", "--trials", "2"];
    with_files_up_to(0, &tune).exits(1).prints(["fusion.alpha", "Accuracy"]).says([&file, "File too large"]);
    let learn = ["learn", &dataset.path, "-o", &file, "--rounds", "2", "--leaves", "2"];
    with_files_up_to(0, &learn).exits(1).prints(["mean"]).says([&file, "File too large"]);
    let check = ["check", &dataset.path, "--write", &file, "--verbose"];
    with_files_up_to(0, &check).exits(1).prints(["radar_front"]).says([&file, "File too large"]);
    assert!(!std::fs::exists(&file).unwrap());
}

#[test]
fn a_simulation_ends_with_the_first_sequence_that_has_no_room() {
    let dataset = Dataset::new();
    let made = dataset.beside("made");
    let world = ["simulate", "-o", &made, "--preset", "worlds", "--scans", "4", "--no-images", "--jobs", "1"];
    let ran =
        with_files_up_to(4, &world).exits(1).ends_with_error(["/sequences/.00.part/", "File too large"]);
    assert_eq!(ran.stderr.lines().count(), 1, "{}", ran.stderr);
    assert!(!std::fs::exists(&made).unwrap());
}
