//! What is no regular file, or far too large, is refused at once and costs no more than itself.

use crate::support::{Dataset, Ran, program, ralf, tree};
use std::fs::{self, File};
use std::path::Path;
use std::process::Command;

fn pipe(file: &Path) {
    let _ = fs::remove_file(file);
    assert!(Command::new("mkfifo").arg(file).status().unwrap().success());
}

/// A file of gigabytes that takes no room on the disk.
fn sparse(file: &Path) {
    File::create(file).unwrap().set_len(3_000_000_000).unwrap();
}

fn device(file: &Path) {
    let _ = fs::remove_file(file);
    std::os::unix::fs::symlink("/dev/zero", file).unwrap();
}

fn label(dataset: &Dataset) -> Ran {
    ralf(["label", &dataset.path, "-o", &dataset.out])
}

#[test]
fn a_radar_scan_that_is_no_regular_file_is_the_only_one_left_out() {
    for (make, told) in [
        (pipe as fn(&Path), "expected a regular file, found a named pipe"),
        (device, "expected a regular file, found a device"),
        (sparse, "RALF_MAX_FILE_MB in the environment raises it"),
    ] {
        let dataset = Dataset::new();
        make(&dataset.file("radar_front/000003.bin"));
        assert_eq!(label(&dataset).exits(3).says([told, "radar_front/000003.bin"]).not_labelled().len(), 1);
        ralf(["inspect", &dataset.path]).exits(0).prints(["radar_front scan 3: ", told]);
    }
}

#[test]
fn an_unreadable_file_costs_its_scan_and_not_the_run() {
    let dataset = Dataset::new();
    let file = dataset.file("radar_front/000003.bin");
    fs::remove_file(&file).unwrap();
    std::os::unix::fs::symlink("nowhere", &file).unwrap();
    let ran = label(&dataset)
        .exits(3)
        .says(["radar_front/000003.bin: expected a regular file, found none of this name"]);
    assert_eq!(ran.not_labelled().len(), 1);
    let record = fs::read_to_string(Path::new(&dataset.out).join("run.json")).unwrap();
    assert!(record.contains("\"blake3\": \"\""), "{record}");
}

#[test]
fn a_limit_is_raised_where_that_is_asked_for() {
    let dataset = Dataset::new();
    let settings = dataset.beside("settings.toml");
    // More than settings may be: lines that say nothing.
    fs::write(&settings, format!("#{}\n", " ".repeat(99)).repeat(170_000)).unwrap();
    for (limit, is_refused) in [("", true), ("20", false)] {
        let mut command = program();
        command.env("RALF_MAX_FILE_MB", limit).args(["label", &dataset.path, "-o", &dataset.out, "--quiet"]);
        let ran = command.args(["--config", &settings]).output().unwrap();
        let told = String::from_utf8_lossy(&ran.stderr);
        assert_eq!(
            (ran.status.success(), told.contains("RALF_MAX_FILE_MB")),
            (!is_refused, is_refused),
            "{told}"
        );
    }
}

#[test]
fn tables_settings_and_networks_that_are_no_files_are_refused() {
    for (name, make) in [
        ("sequence.toml", pipe as fn(&Path)),
        ("odometry.csv", device),
        ("radar_front/timestamps.txt", sparse),
    ] {
        let dataset = Dataset::new();
        make(&dataset.file(name));
        label(&dataset).exits(1).says([name, "expected "]);
    }
    let dataset = Dataset::new();
    for (name, make) in [("pipe", pipe as fn(&Path)), ("device", device), ("sparse", sparse)] {
        let network = dataset.beside(&format!("{name}.onnx"));
        make(Path::new(&network));
        fs::write(dataset.beside(&format!("{name}.toml")), "preset = \"midas-small\"").unwrap();
        let ran = ralf(["label", &dataset.path, "-o", &dataset.out, "--depth-model", &network]).exits(1);
        ran.says([".onnx: expected "]);
        let settings = dataset.beside(&format!("{name}-settings.toml"));
        make(Path::new(&settings));
        let ran = ralf(["label", &dataset.path, "-o", &dataset.out, "--config", &settings]).exits(1);
        ran.says(["settings.toml: expected "]);
    }
}

#[test]
fn nothing_that_is_read_is_written_over() {
    let dataset = Dataset::new();
    label(&dataset).exits(0);
    let scan = dataset.file("radar_front/000000.bin").to_string_lossy().into_owned();
    let run = dataset.result("../../run.json").to_string_lossy().into_owned();
    let (recorded, labelled) = (tree(&dataset.path), tree(&dataset.out));
    let (path, out) = (dataset.path.as_str(), dataset.out.as_str());
    for place in [&scan, &run] {
        ralf(["plot", path, out, "--scan", "1", "-o", place]).exits(2).says(["--output: expected a place"]);
        ralf(["report", path, out, "-o", place]).exits(2).says(["--output: expected a place"]);
    }
    ralf(["check", path, "--write", &scan])
        .exits(2)
        .says(["--write: expected a place where nothing is lost"]);
    ralf(["check", path, "-o", &scan]).exits(2).says(["--output: expected a place where nothing is lost"]);
    let compared = ["simulate", "--compare", path, "--preset", "tiny", "-o", &scan];
    ralf(compared).exits(2).says(["--output: expected a place where nothing is lost"]);
    let pipe_at = dataset.beside("pipe");
    pipe(Path::new(&pipe_at));
    ralf(["report", path, out, "-o", &pipe_at])
        .exits(2)
        .says(["expected a file, found what is no regular file"]);
    assert!(tree(path) == recorded && tree(out) == labelled);
    // A page beside the results may be drawn anew.
    let page = format!("{out}/report.html");
    for _ in 0..2 {
        ralf(["report", path, out, "-o", &page]).exits(0);
    }
}

#[test]
fn nothing_new_is_written_where_it_would_be_a_part_of_a_recording_or_of_results() {
    let dataset = Dataset::new();
    label(&dataset).exits(0);
    let (path, out) = (dataset.path.as_str(), dataset.out.as_str());
    let (recorded, labelled) = (tree(path), tree(out));
    let inside = |name: &str| dataset.file(name).to_string_lossy().into_owned();
    let [scan, settings] = ["radar_front/000099.bin", "sequence2.toml"].map(inside);
    let [picture, page] = ["camera_front/000099.png", "lidar_top/000099.html"].map(inside);
    let [database, team] = ["corrections.sqlite", "team.toml"].map(|name| format!("{out}/{name}"));
    let outside = "expected a place outside recordings";
    ralf(["plot", path, out, "--scan", "1", "-o", &picture]).exits(2).says([outside]);
    ralf(["report", path, out, "-o", &page]).exits(2).says([outside]);
    ralf(["check", path, "--write", &scan]).exits(2).says([outside]);
    ralf(["tune", path, "--train", "00", "--cross-validate", "-o", &settings]).exits(2);
    ralf(["tune", path, "--train", "00", "--test", "01", "-o", &settings]).exits(2).says([outside]);
    ralf(["learn", path, "-o", &database]).exits(2).says(["`corrections.sqlite` of", "which is ralf's own"]);
    ralf(["check", path, "--write", &team]).exits(2).says(["`team.toml` of", "which is ralf's own"]);
    for name in ["sequences/export", "second"] {
        let export = ["export", path, out, "--to", "npz", "-o", &format!("{out}/{name}")];
        ralf(export).exits(1).says(["which is ralf's own"]);
    }
    assert!(tree(path) == recorded && tree(out) == labelled);
    // Beside what is the program's own there is room.
    ralf(["export", path, out, "--to", "npz", "-o", &format!("{out}/export")]).exits(0);
    ralf(["plot", path, out, "--scan", "1", "-o", &format!("{out}/scan.png")]).exits(0);
}

#[test]
fn a_picture_replaces_nothing_but_a_picture() {
    let dataset = Dataset::new();
    label(&dataset).exits(0);
    let [settings, makefile, new, picture] =
        ["ralf.toml", "Makefile", "both.toml", "scan.png"].map(|name| dataset.beside(name));
    fs::write(&settings, "[lidar]\n").unwrap();
    fs::write(&makefile, "all:\n").unwrap();
    let (path, out) = (dataset.path.as_str(), dataset.out.as_str());
    for (file, told) in
        [(&settings, "ends in .png"), (&makefile, "which would be lost"), (&new, "ends in .png")]
    {
        ralf(["check", path, "-o", file]).exits(2).ends_with_error(["--output: ", file, told]);
        ralf(["plot", path, out, "--scan", "1", "-o", file]).exits(2).ends_with_error([
            "--output: ",
            file,
            told,
        ]);
    }
    let both = dataset.beside("both.png");
    ralf(["check", path, "--write", &both, "-o", &both])
        .exits(2)
        .says(["--write and --output: expected two files"]);
    assert!(!Path::new(&both).exists() && !Path::new(&new).exists());
    assert_eq!(fs::read_to_string(&makefile).unwrap(), "all:\n");
    for _ in 0..2 {
        ralf(["plot", path, out, "--scan", "1", "-o", &picture]).exits(0);
        ralf(["check", path, "-o", &picture]).exits(0);
    }
}
