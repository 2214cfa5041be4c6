//! `ralf inspect`, `ralf plot` and `ralf convert`.

use crate::support::{Dataset, Shape, ralf, tree};
use ralf_data::result::LabelledRun;
use ralf_plot::Extent;
use ralf_report::Pictures;
use std::fs;

fn labelled() -> Dataset {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

/// Width and height of a picture, which must be a PNG.
fn size(file: &str) -> [u32; 2] {
    let bytes = fs::read(file).unwrap();
    assert_eq!(bytes[..8], *b"\x89PNG\r\n\x1a\n");
    assert_eq!(bytes[12..16], *b"IHDR");
    assert!(bytes.ends_with(b"IEND\xaeB`\x82"));
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()))
}

#[test]
fn options_that_would_change_nothing_are_refused() {
    for more in [["--segmentation"].as_slice(), &["--no-images"], &["--with", "other", "--no-images"]] {
        let told =
            crate::support::program().args(["simulate", "--compare", "city"]).args(more).output().unwrap();
        crate::support::Ran::of(&told).exits(2).says(["cannot be used with", "--compare"]);
    }
    ralf(["evaluate", "out", "--changed-recording"]).exits(2).says(["required arguments", "--truth"]);
}

#[test]
fn inspect_tells_what_is_there_and_what_is_missing() {
    let dataset = Dataset::new();
    let ran = ralf(["inspect", &dataset.path]).exits(0).says_nothing();
    ran.prints([
        "radar_front",
        "radar_left",
        "lidar_top",
        "10.0 Hz",
        "no camera",
        "no 6-DoF poses",
        "a street",
        "range rates: `doppler` is raw",
        "LiDAR: points are motion-corrected to the scan's time",
    ]);
}

#[test]
fn a_scan_a_radar_and_a_sequence_are_drawn() {
    let dataset = labelled();
    let picture = dataset.beside("picture.png");
    let plot = |what: &[&str]| {
        let run = crate::support::program()
            .args(["plot", &dataset.path, &dataset.out, "-o", &picture])
            .args(what)
            .output()
            .unwrap();
        crate::support::Ran::of(&run).exits(0).prints_nothing().says([&picture]);
        fs::read(&picture).unwrap()
    };
    let all = plot(&["--scan", "1"]);
    assert!(size(&picture).iter().all(|pixels| (300..5000).contains(pixels)));
    let one = plot(&["--scan", "1", "--radar", "radar_left", "--radius", "30"]);
    let sequence = plot(&["--all"]);
    assert!(size(&picture).iter().all(|pixels| (300..5000).contains(pixels)));
    assert!(all != one && one != sequence);
    assert!(plot(&["--all"]) == sequence, "the same picture twice");
}

#[test]
fn what_can_not_be_drawn_is_refused() {
    let dataset = labelled();
    let picture = dataset.beside("picture.png");
    let (path, out) = (dataset.path.as_str(), dataset.out.as_str());
    ralf(["plot", path, out, "--scan", "3", "-o", &picture]).exits(1).says(["from 0 to 2, found 3"]);
    let radar = ["plot", path, out, "--scan", "0", "--radar", "radar_back", "-o", &picture];
    ralf(radar).exits(1).says(["radar_front, radar_left", "radar_back"]);
    let nothing = dataset.beside("nothing");
    ralf(["plot", path, &nothing, "--scan", "0", "-o", &picture]).exits(1).says([&nothing, "run.json"]);
    assert!(!fs::exists(&picture).unwrap());
    let nowhere = dataset.beside("nowhere/picture.png");
    let parent_is_made = ralf(["plot", path, out, "--scan", "0", "-o", &nowhere]).exits(0);
    parent_is_made.says([&nowhere]);
}

#[test]
fn an_unknown_radar_is_refused_for_a_whole_sequence_too() {
    let dataset = labelled();
    let picture = dataset.beside("picture.png");
    let all = ["plot", &dataset.path, &dataset.out, "--all", "--radar", "radar_back", "-o", &picture];
    ralf(all).exits(1).says(["radar_front, radar_left", "radar_back"]);
}

#[test]
fn converting_the_own_layout_changes_no_measurement() {
    let dataset = Dataset::of(&Shape { scans: 3, classes: true, ..Shape::default() });
    let copy = dataset.beside("copy");
    ralf(["convert", &dataset.path, "-o", &copy]).exits(0).prints_nothing().says(["sequences/00"]);
    let (mut before, mut after) = (tree(&dataset.path), tree(&copy));
    for rewritten in ["sequences/00/sequence.toml", "sequences/00/odometry.csv"] {
        assert!(before.remove(rewritten).is_some() && after.remove(rewritten).is_some());
    }
    assert!(before == after);
    // And it means the same.
    let [one, other] = [&dataset.path, &copy].map(|path| {
        let out = format!("{path}-out");
        ralf(["label", path, "-o", &out]).exits(0);
        fs::read(format!("{out}/sequences/00/plausibility.parquet")).unwrap()
    });
    assert!(one == other);
}

/// A motion that a sequence is without is as much a part of it.
#[test]
fn a_sequence_with_more_than_is_to_be_written_is_another_one() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let copy = dataset.beside("copy");
    let convert = || ralf(["convert", &dataset.path, "-o", &copy]);
    convert().exits(0);
    let refused = |file: &str| {
        let found = format!("another one: its {file} is no part of it");
        convert().exits(1).ends_with_error(["sequences/00: folder: expected none of this name yet", &found]);
    };
    for file in ["poses.csv", "lidar_top/000000.time"] {
        let there = format!("{copy}/sequences/00/{file}");
        fs::write(&there, "").unwrap();
        refused(file);
        fs::remove_file(there).unwrap();
    }
    // What people add of the same measurements stays.
    for file in ["lidar_top/000000.label", "ground_truth/radar_front/000000.cause"] {
        fs::write(format!("{copy}/sequences/00/{file}"), "").unwrap();
    }
    fs::remove_file(dataset.file("ground_truth/radar_left/000000.label")).unwrap();
    convert().exits(0).says(["kept as it is"]);
    let odometry = fs::read(dataset.file("odometry.csv")).unwrap();
    fs::remove_file(dataset.file("odometry.csv")).unwrap();
    refused("odometry.csv");
    dataset.put("odometry.csv", odometry);
    convert().exits(0).says(["kept as it is"]);
}

#[test]
fn a_conversion_overwrites_nothing() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let copy = dataset.beside("copy");
    ralf(["convert", &dataset.path, "-o", &copy]).exits(0);
    let before = tree(&copy);
    ralf(["convert", &dataset.path, "-o", &copy])
        .exits(0)
        .says(["kept as it is, for it is there already", "sequences/00"]);
    // Another sequence of this name is not taken for it.
    let longer = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    ralf(["convert", &longer.path, "-o", &copy]).exits(1).ends_with_error([
        "sequences/00: folder: expected none of this name yet",
        "another one",
        "differs",
    ]);
    // Nor is one of the same sensors and times, but other measurements.
    let mirrored = ["--set", "corrections.radar_front.mirror_y=true"];
    ralf(["convert", &dataset.path, "-o", &copy, mirrored[0], mirrored[1]])
        .exits(1)
        .ends_with_error(["another one: its radar_front/000000.bin differs"]);
    assert!(tree(&copy) == before);
    let inside = format!("{}/sequences/new", dataset.path);
    for place in [&dataset.path, &inside] {
        ralf(["convert", &dataset.path, "-o", place])
            .exits(1)
            .says(["expected a place outside the recording"]);
    }
    ralf(["inspect", &dataset.path, "--quick"]).exits(0);
    assert!(tree(&copy) == before);
}

#[test]
fn a_conversion_makes_the_file_that_its_name_says_or_refuses_it() {
    let dataset = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let path = |name: &str| dataset.beside(name);
    for name in ["a.MCAP", "b.Bag"] {
        ralf(["convert", &dataset.path, "-o", &path(name)]).exits(0);
        assert!(fs::metadata(path(name)).unwrap().is_file(), "{name}");
        ralf(["inspect", &path(name), "--quick"]).exits(0);
    }
    for name in ["c.db3", "c.DB3", "c.zip", "c.h5"] {
        ralf(["convert", &dataset.path, "-o", &path(name)]).exits(2).ends_with_error([".mcap or .bag", name]);
        assert!(!fs::exists(path(name)).unwrap());
    }
    ralf(["convert", &dataset.path, "-o", &path("nuscenes.v1")]).exits(0);
}

#[test]
fn an_overview_of_one_radar_says_so_and_counts_its_scans() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let recording = ralf_data::open(dataset.path.as_ref(), None).unwrap();
    let run = LabelledRun::open(dataset.out.as_ref()).unwrap();
    let tables = run.table(&run.record().sequences[0]).unwrap();
    let of = |radar| {
        let reader = recording.sequences[0].as_ref();
        Pictures { reader, tables: &tables, radar, extent: Extent::Fit }.overview_of()
    };
    assert_eq!(of(None), "all radars, 16 scans accumulated");
    assert_eq!(of(Some("radar_left")), "radar_left, 8 scans accumulated");
}
