//! Inputs are only read.

use crate::support::{Dataset, Ran, Shape, as_nobody, nuscenes, program, ralf, tree};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::Command;

#[test]
fn no_command_touches_the_recording() {
    let dataset = Dataset::new();
    let before = tree(&dataset.path);
    let picture = dataset.beside("scan.png");
    ralf(["inspect", &dataset.path]).exits(0);
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    ralf(["evaluate", &dataset.out, "--truth", &dataset.path]).exits(0);
    ralf(["plot", &dataset.path, &dataset.out, "--scan", "0", "-o", &picture]).exits(0);
    ralf(["convert", &dataset.path, "-o", &dataset.beside("copy")]).exits(0);
    assert!(tree(&dataset.path) == before);
}

#[test]
fn results_do_not_go_into_the_recording() {
    let dataset = Dataset::new();
    let before = tree(&dataset.path);
    for inside in ["", "/sequences", "/sequences/00", "/sequences/new", "/sequences/../sequences/new/folder"]
    {
        let out = format!("{}{inside}", dataset.path);
        ralf(["label", &dataset.path, "-o", &out])
            .exits(1)
            .prints_nothing()
            .says(["outside the recording", &out]);
        assert!(tree(&dataset.path) == before, "{inside}");
    }
}

#[test]
fn results_that_have_no_place_are_refused_before_anything_is_done() {
    let dataset = Dataset::new();
    for (name, folder) in [("run.json", true), ("sequences", false)] {
        let out = dataset.beside(&format!("out of {name}"));
        let taken = format!("{out}/{name}");
        fs::create_dir(&out).unwrap();
        if folder { fs::create_dir(&taken) } else { fs::write(&taken, "mine") }.unwrap();
        let before = tree(&out);
        let refused = ralf(["label", &dataset.path, "-o", &out]).exits(1).prints_nothing();
        refused.says([&taken, "or nothing yet, found a f"]);
        assert_eq!(tree(&out), before);
    }
    let file = dataset.beside("file");
    fs::write(&file, "mine").unwrap();
    ralf(["label", &dataset.path, "-o", &file])
        .exits(1)
        .says(["expected a folder, or nothing yet, found a file"]);
}

#[test]
fn what_is_somebody_elses_is_not_replaced() {
    let dataset = Dataset::new();
    let out = dataset.beside("out of another");
    fs::create_dir(&out).unwrap();
    let record = format!("{out}/run.json");
    for content in ["{\"wandb\": \"my run\"}", "{\"version\": \"1\"}", "[1]", "my notes", ""] {
        fs::write(&record, content).unwrap();
        let before = tree(&out);
        let refused = ralf(["label", &dataset.path, "-o", &out]).exits(1).prints_nothing();
        refused.ends_with_error([
            &record,
            "expected a record of `ralf label`, or nothing yet, found another file",
        ]);
        assert_eq!(tree(&out), before);
    }
    let other = Dataset::new();
    let before = tree(&other.path);
    let refused = ralf(["label", &dataset.path, "-o", &other.path]).exits(1).prints_nothing();
    refused.ends_with_error([&other.path, "expected a folder of labels, or nothing yet, found a recording"]);
    assert!(tree(&other.path) == before);
    // A record of one's own may be damaged, and is made again.
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let record = format!("{}/run.json", dataset.out);
    let whole = fs::read(&record).unwrap();
    for damaged in [&whole[..whole.len() / 2], &vec![0; whole.len()], b""] {
        fs::write(&record, damaged).unwrap();
        ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
        assert!(fs::read_to_string(&record).unwrap().starts_with("{\n  \"version\": "));
    }
}

fn run(arguments: &[&str]) -> Ran {
    Ran::of(&program().args(arguments).output().unwrap())
}

#[test]
fn labels_that_people_have_made_and_recordings_of_other_formats_take_no_labels() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    let [made, foreign, lost] = ["made", "foreign", "lost"].map(|name| dataset.beside(name));
    fs::create_dir_all(format!("{made}/sequences/00/radar_front")).unwrap();
    let label = format!("{made}/sequences/00/radar_front/000000.label");
    fs::write(&label, 99_u32.to_le_bytes()).unwrap();
    nuscenes(Path::new(&foreign));
    for (place, found) in [
        (&made, format!("found {label} without a table, which would be lost")),
        (&foreign, "found a recording of the format nuscenes".to_owned()),
    ] {
        let before = tree(place);
        let refused = ralf(["label", &dataset.path, "-o", place]).exits(1).prints_nothing();
        refused.ends_with_error([place.as_str(), &found]);
        assert!(tree(place) == before, "{place}");
    }
    // Labels of ours whose record is lost are made again.
    ralf(["label", &dataset.path, "-o", &lost]).exits(0);
    fs::remove_file(format!("{lost}/run.json")).unwrap();
    ralf(["label", &dataset.path, "-o", &lost]).exits(0);
}

#[test]
fn nothing_is_written_among_the_sequences_of_a_recording() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    let other = Dataset::of(&Shape { scans: 1, ..Shape::default() });
    let before = tree(&other.path);
    for place in ["sequences", "sequences/05", "sequences/00/radar_front/out"] {
        let place = format!("{}/{place}", other.path);
        let file = format!("{place}/copy.mcap");
        for command in [
            &["label", &dataset.path, "-o", &place][..],
            &["convert", &dataset.path, "-o", &place],
            &["convert", &dataset.path, "-o", &file],
            &["convert", &other.path, "-o", &file],
            &["simulate", "--preset", "tiny", "--scans", "1", "-o", &place],
        ] {
            let refused = run(command).exits(1).prints_nothing();
            refused.ends_with_error([place.as_str(), "expected a place outside recordings, found a part of"]);
        }
        assert!(tree(&other.path) == before, "{place}");
    }
    ralf(["label", &dataset.path, "-o", &format!("{}/out", other.path)]).exits(0);
}

#[test]
fn recordings_do_not_go_among_labels_nor_into_those_of_other_formats() {
    let dataset = Dataset::of(&Shape { scans: 2, ..Shape::default() });
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let [begun, corrected, foreign, made] =
        ["begun", "corrected", "foreign", "made"].map(|name| dataset.beside(name));
    fs::create_dir_all(format!("{begun}/.ralf-run")).unwrap();
    fs::create_dir_all(format!("{corrected}/sequences/00")).unwrap();
    fs::write(format!("{corrected}/corrections.sqlite"), "").unwrap();
    nuscenes(Path::new(&foreign));
    for (place, found) in [
        (&dataset.out, "labels, with run.json"),
        (&begun, "labels, with .ralf-run"),
        (&corrected, "labels, with corrections.sqlite"),
        (&foreign, "a recording of the format nuscenes"),
    ] {
        let before = tree(place);
        let told = [place, "expected a recording in the own layout, or nothing yet", found];
        ralf(["simulate", "--preset", "tiny", "--scans", "1", "-o", place]).exits(1).ends_with_error(told);
        ralf(["convert", &dataset.path, "-o", place]).exits(1).ends_with_error(told);
        assert!(tree(place) == before, "{place}");
    }
    // What one of them has made, the other may go on with.
    ralf(["convert", &dataset.path, "-o", &made]).exits(0);
    for _ in 0..2 {
        ralf(["simulate", "--preset", "tiny", "--scans", "1", "-o", &made]).exits(0);
    }
    ralf(["convert", &dataset.path, "-o", &made]).exits(0).says(["kept as it is"]);
}

#[test]
fn a_recording_that_can_not_be_written_is_labelled() {
    let dataset = Dataset::new();
    let all = tree(&dataset.path);
    let each = || all.iter().map(|(name, file)| (Path::new(&dataset.path).join(name), file.is_some()));
    let allow = |folder: u32, file: u32| {
        for (path, is_file) in each() {
            fs::set_permissions(path, fs::Permissions::from_mode(if is_file { file } else { folder }))
                .unwrap();
        }
    };
    let Some(mut label) = as_nobody(&dataset) else { return println!("skipped: root without setpriv") };
    allow(0o555, 0o444);
    let ran = label.args(["label", &dataset.path, "-o", &dataset.out]).output().unwrap();
    allow(0o755, 0o644);
    Ran::of(&ran).exits(0).says_nothing();
}

#[test]
fn a_file_without_permission_is_named() {
    let dataset = Dataset::new();
    let secret = dataset.file("radar_front/000002.bin");
    fs::set_permissions(&secret, fs::Permissions::from_mode(0o000)).unwrap();
    let Some(mut label) = as_nobody(&dataset) else { return println!("skipped: root without setpriv") };
    let ran = label.args(["label", &dataset.path, "-o", &dataset.out]).output().unwrap();
    let ran = Ran::of(&ran).exits(3).says(["radar_front/000002.bin", "Permission denied"]);
    assert_eq!(ran.not_labelled().len(), 1);
}

#[test]
fn a_results_folder_without_permission_is_named() {
    let dataset = Dataset::new();
    let Some(mut label) = as_nobody(&dataset) else { return println!("skipped: root without setpriv") };
    fs::create_dir(dataset.beside("locked")).unwrap();
    fs::set_permissions(dataset.beside("locked"), fs::Permissions::from_mode(0o555)).unwrap();
    let out = dataset.beside("locked/out");
    let ran = label.args(["label", &dataset.path, "-o", &out]).output().unwrap();
    Ran::of(&ran).exits(1).says(["locked/out", "Permission denied"]);
}

#[test]
fn results_that_nobody_may_write_are_complete_all_the_same() {
    let dataset = Dataset::new();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let Some(nobody) = as_nobody(&dataset) else { return println!("skipped: root without setpriv") };
    let allow = |mode| fs::set_permissions(&dataset.out, fs::Permissions::from_mode(mode)).unwrap();
    let before = tree(&dataset.out);
    allow(0o555);
    let run = |further: &[&str]| {
        let mut label = Command::new(nobody.get_program());
        label.args(nobody.get_args()).args(["label", &dataset.path, "-o", &dataset.out]).args(further);
        Ran::of(&label.output().unwrap())
    };
    run(&[]).exits(0).says(["nothing to do"]);
    // What would have to be written is named.
    run(&["--set", "fusion.threshold=0.9"]).exits(1).says([&dataset.out, "Permission denied"]);
    allow(0o755);
    assert!(tree(&dataset.out) == before);
}
