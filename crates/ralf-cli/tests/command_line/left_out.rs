//! What a command leaves out is named, and its exit status tells; what a person has made is not written over.

use crate::support::{Dataset, Ran, Shape, program, ralf};
use ralf_corrections::{FILE, ScanEdit, Store, Stroke, Who};
use std::fs;
use std::path::Path;

/// A labelled recording of two sequences.
fn two() -> Dataset {
    let dataset = Dataset::of(&Shape { scans: 3, sequences: &["00", "01"], ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    dataset
}

/// Somebody corrects a detection of the first scan of a sequence.
fn correct(dataset: &Dataset, sequence: &str) {
    correct_one_of(dataset, sequence, 0);
}

/// The same, when the scan held so many detections more than now.
fn correct_one_of(dataset: &Dataset, sequence: &str, more: u32) {
    let file = format!("{}/sequences/{sequence}/radar_front/000000.label", dataset.out);
    let detections = fs::metadata(file).unwrap().len() as u32 / 4 + more;
    let radar = "radar_front".to_owned();
    let edit = ScanEdit { radar, detections, points: vec![0], ..ScanEdit::default() };
    let stroke = Stroke { label: Some(10), scans: vec![edit], ..Stroke::of_sequence(sequence) };
    let mut store = Store::open(&Path::new(&dataset.out).join(FILE)).unwrap();
    store.apply(&stroke, &Who::named("ada")).unwrap();
}

#[track_caller]
fn run(arguments: &[&str], more: &[&str]) -> Ran {
    Ran::of(&program().args(arguments).args(more).output().unwrap())
}

#[test]
fn a_recording_that_lost_a_whole_sequence_is_refused_by_its_name() {
    let dataset = two();
    correct(&dataset, "01");
    let sequence = format!("{}/sequences/01", dataset.path);
    let away = dataset.beside("away");
    fs::rename(&sequence, &away).unwrap();
    let [path, out] = [&dataset.path, &dataset.out].map(String::as_str);
    let [labels, page, chosen] = ["labels", "page.html", "chosen"].map(|name| dataset.beside(name));
    let export = ["export", path, out, "--to", "npz", "-o", &labels];
    for asked in [&export[..], &["report", path, out, "-o", &page], &["evaluate", out, "--truth", path]] {
        run(asked, &[]).exits(1).prints_nothing().ends_with_error([
            path,
            "found none of 01",
            "put them back",
        ]);
        run(asked, &["--changed-recording"]).exits(0).says(["warning: ", "found none of 01"]);
    }
    // Who has chosen knows what is left out.
    run(&["export", path, out, "--to", "npz", "--sequence", "00", "-o", &chosen], &[]).exits(0);
    // What was corrected is told of where it is not labelled any more, too.
    ralf(["label", path, "-o", out, "--set", "fusion.threshold=0.9"]).exits(0);
    run(&export, &["--force"]).exits(1).says(["found none of 01"]);
    fs::rename(&away, &sequence).unwrap();
    run(&export, &["--force"]).exits(3).says(["sequence 01 has no labels: left out"]);
}

#[test]
fn corrections_of_another_recording_are_told_apart_from_none() {
    let (dataset, other) = (two(), Dataset::of(&Shape { scans: 3, sequences: &["07"], ..Shape::default() }));
    let model = dataset.beside("model");
    let [path, out, model] = [&dataset.path, &dataset.out, &model].map(String::as_str);
    correct(&dataset, "00");
    let learn = ["learn", path, &other.path, "--from", out, "-o", model, "-q"];
    let told = format!("corrections.sqlite: expected corrections, found none that fit {}", other.path);
    run(&learn, &[]).exits(1).ends_with_error([&told]);
}

#[test]
fn corrections_of_other_detections_are_left_out_of_what_is_searched_for() {
    let dataset = two();
    correct(&dataset, "00");
    let [path, out] = [&dataset.path, &dataset.out].map(String::as_str);
    let settings = dataset.beside("found.toml");
    let sequences = [path, "--train", "00", "--test", "01", "--corrections", out, "--trials", "1"];
    let tune = [&["tune", "-o", &settings][..], &sequences].concat();
    let ablate = [&["ablate"][..], &sequences].concat();
    run(&tune, &[]).exits(0);
    correct_one_of(&dataset, "01", 1);
    for asked in [tune, ablate] {
        run(&asked, &[]).exits(3).says(["corrections of 01/radar_front/000000 are kept and not applied"]);
    }
}

#[test]
fn corrections_of_other_detections_are_left_out_of_what_is_learned() {
    let dataset = two();
    correct(&dataset, "00");
    let [path, out] = [&dataset.path, &dataset.out].map(String::as_str);
    let model = dataset.beside("model");
    let learn = ["learn", path, "--from", out, "-o", &model, "--rounds", "2", "--leaves", "2"];
    run(&learn, &[]).exits(0).prints(["  00 ", "before", "after"]);
    let before = fs::read(&model).unwrap();
    correct_one_of(&dataset, "01", 1);
    run(&learn, &[]).exits(3).says(["corrections of 01/radar_front/000000 are kept and not applied"]);
    assert!(fs::read(&model).unwrap() == before);
}

#[test]
fn scans_that_could_not_be_labelled_are_named_and_not_drawn_as_if_nothing_were_plausible() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() });
    dataset.cut("radar_front/000001.bin", 3);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(3);
    let [path, out] = [&dataset.path, &dataset.out].map(String::as_str);
    let [picture, page] = ["scan.png", "page.html"].map(|name| dataset.beside(name));
    let told = "not labelled: 00 radar_front scan 1: ";
    let plot = ["plot", path, out, "-o", &picture];
    run(&plot, &["--scan", "1", "--radar", "radar_front"]).exits(1).ends_with_error([told, "000001.bin"]);
    assert!(!fs::exists(&picture).unwrap());
    for more in [&["--scan", "1"][..], &["--all"], &["--all", "--radar", "radar_front"]] {
        run(&plot, more).exits(3).says([told]);
    }
    for more in [&["--scan", "0"][..], &["--scan", "1", "--radar", "radar_left"]] {
        let ran = run(&plot, more).exits(0);
        assert!(!ran.stderr.contains("not labelled"), "{}", ran.stderr);
    }
    run(&["report", path, out, "-o", &page], &[]).exits(3).says([told, "wrote "]);
    run(&["evaluate", out], &[]).exits(3).says([told]).prints(["overall"]);
}

#[test]
fn corrections_are_written_over_by_no_command() {
    let dataset = two();
    let other = dataset.beside("corrections.sqlite");
    drop(Store::open(Path::new(&other)).unwrap());
    let before = fs::read(&other).unwrap();
    let [path, out] = [&dataset.path, &dataset.out].map(String::as_str);
    for asked in [
        &["tune", path, "--train", "00", "--test", "01", "--trials", "2", "-o", &other][..],
        &["learn", path, "-o", &other],
        &["report", path, out, "-o", &other],
        &["check", path, "--write", &other],
        &["simulate", "--compare", path, "-o", &other],
    ] {
        run(asked, &[]).exits(2).ends_with_error(["where nothing is lost, found a database", &other]);
        assert!(fs::read(&other).unwrap() == before, "{asked:?}");
    }
}

#[test]
fn a_picture_is_no_file_of_another_format() {
    let dataset = two();
    let [photo, whole] = ["p.jpg", "p.PNG"].map(|name| dataset.beside(name));
    let [path, out] = [&dataset.path, &dataset.out].map(String::as_str);
    let plot = ["plot", path, out, "--sequence", "00", "--scan", "1"];
    run(&plot, &["-o", &photo]).exits(2).ends_with_error(["expected a name that ends in .png", &photo]);
    assert!(!fs::exists(&photo).unwrap());
    run(&plot, &["-o", &whole, "--radius", "0.01"]).exits(0);
    // An overview has one colour for each class, and is seen from above.
    let overview = ["plot", path, out, "--sequence", "00", "--all", "-o", &whole];
    for chosen in [["--color-by", "doppler"], ["--camera", "front"]] {
        run(&overview, &chosen).exits(2).ends_with_error(["--all", "cannot be used with", chosen[0]]);
    }
    for radius in ["1e-6", "1e-30"] {
        let told = ["expected a radius of 0.01 to 100000000 m, found 0.0000"];
        run(&plot, &["-o", &whole, "--radius", radius]).exits(1).ends_with_error(told);
    }
}
