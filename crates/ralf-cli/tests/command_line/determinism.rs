//! The same recording and settings give the same bytes.

use crate::support::{Dataset, Ran, Shape, program, ralf, tree, without_timings};
use std::fs;
use std::path::Path;

#[test]
fn the_number_of_jobs_changes_no_byte() {
    // Several stretches, so that several threads have work.
    let dataset = Dataset::of(&Shape { scans: 70, ..Shape::default() });
    let other = dataset.beside("other");
    ralf(["label", &dataset.path, "-o", &dataset.out, "--jobs", "1"]).exits(0);
    ralf(["label", &dataset.path, "-o", &other, "--jobs", "4"]).exits(0);
    assert!(without_timings(&dataset.out) == without_timings(&other));
}

/// Shorter than a stretch, so that several are under way at a time; one has a scan that can't be labelled.
#[test]
fn sequences_side_by_side_are_what_one_after_the_other_gives() {
    let dataset = Dataset::of(&Shape { scans: 9, sequences: &["00", "01", "02", "03"], ..Shape::default() });
    fs::write(Path::new(&dataset.path).join("sequences/01/radar_left/000003.bin"), "cut").unwrap();
    let other = dataset.beside("other");
    let label = |out: &str, jobs: &str| {
        ralf(["label", &dataset.path, "-o", out, "--jobs", jobs, "--json"]).exits(3).stdout
    };
    label(&dataset.out, "1");
    label(&other, "3");
    assert!(without_timings(&dataset.out) == without_timings(&other));
    assert!(!Path::new(&other).join(".ralf-run").exists());
}

#[test]
fn the_number_of_jobs_changes_no_byte_of_evidence() {
    // With four jobs windows begin anew within the recording, with one they don't.
    let dataset = Dataset::of(&Shape { scans: 90, ..Shape::default() });
    let other = dataset.beside("other");
    ralf(["label", &dataset.path, "-o", &dataset.out, "--evidence", "--jobs", "1"]).exits(0);
    ralf(["label", &dataset.path, "-o", &other, "--evidence", "--jobs", "4"]).exits(0);
    assert!(without_timings(&dataset.out) == without_timings(&other));
}

#[test]
fn the_same_command_again_has_nothing_to_do() {
    let dataset = Dataset::new();
    let label = || ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let first = label().says_nothing();
    let before = tree(&dataset.out);
    let second = label().says(["nothing to do"]);
    assert!(tree(&dataset.out) == before);
    // The table is the same; how fast it was made is told once.
    assert!(first.stdout.starts_with(&second.stdout) && first.stdout.contains("detections in"), "{first:?}");
}

#[test]
fn a_result_that_was_deleted_is_made_again() {
    let dataset = Dataset::new();
    let label = || ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    label().says_nothing();
    let before = without_timings(&dataset.out);
    for lost in ["plausibility.parquet", "radar_left/000004.label"] {
        fs::remove_file(dataset.result(lost)).unwrap();
        label().says(["sequence 00 is labelled again", lost]);
        assert!(without_timings(&dataset.out) == before, "{lost}");
    }
}

#[test]
fn a_recording_that_changed_is_labelled_again() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let before = tree(&dataset.out);
    dataset.edit("sequence.toml", "sigma_azimuth_deg = 0.6", "sigma_azimuth_deg = 0.7");
    let told = "sequence 00 is labelled again: it is read from other inputs than before";
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0).says([told]);
    assert!(
        tree(&dataset.out)["sequences/00/plausibility.parquet"]
            != before["sequences/00/plausibility.parquet"]
    );
}

/// Words about files that can't be read, too.
#[test]
fn the_folder_that_a_recording_is_typed_from_changes_no_byte() {
    let dataset = Dataset::of(&Shape { scans: 6, ..Shape::default() }).with_camera(6);
    for file in ["radar_left/000003.bin", "lidar_top/000002.bin"] {
        dataset.cut(file, 1);
    }
    dataset.put("camera_front/000001.png", "no image");
    let (beside, other) = (dataset.beside(""), dataset.beside("other"));
    ralf(["label", "-q", &dataset.path, "-o", &dataset.out]).exits(3);
    let here = ["label", "-q", "dataset", "-o", "other"];
    Ran::of(&program().current_dir(beside).args(here).output().unwrap()).exits(3);
    assert!(without_timings(&dataset.out) == without_timings(&other));
}
