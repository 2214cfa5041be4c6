//! A report tells of what is labelled, and names what isn't.

use crate::support::{Dataset, Ran, Shape, program, ralf};
use std::fs;

#[test]
fn a_partly_labelled_recording_is_reported_as_far_as_it_is() {
    let dataset = Dataset::of(&Shape { scans: 4, sequences: &["00", "01", "02"], ..Shape::default() });
    let page = dataset.beside("report.html");
    for sequence in ["00", "02"] {
        ralf(["label", &dataset.path, "-o", &dataset.out, "--sequence", sequence]).exits(0);
    }
    ralf(["report", &dataset.path, &dataset.out, "-o", &page])
        .exits(3)
        .says(["sequence 01 has no labels: left out"]);
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("Sequences without labels") && html.contains("<li>01</li>"));
    assert!(html.contains("Sequence 00, scan") && html.contains("Sequence 02, scan"));
    assert!(!html.contains("Sequence 01, scan"));
    fs::remove_file(&page).unwrap();
    ralf(["report", &dataset.path, &dataset.out, "-o", &page, "--sequence", "01"])
        .exits(1)
        .says(["run.json, sequences: expected labels of the recording", "01"]);
    assert!(!fs::exists(&page).unwrap());
}

/// Truth may be there for some sequences by design.
#[test]
fn sequences_without_truth_are_named() {
    let dataset = Dataset::of(&Shape { scans: 2, sequences: &["00", "01"], ..Shape::default() });
    let page = dataset.beside("report.html");
    fs::remove_dir_all(format!("{}/sequences/01/ground_truth", dataset.path)).unwrap();
    ralf(["label", &dataset.path, "-o", &dataset.out]).exits(0);
    let told = "sequence 01 has no truth: left out";
    ralf(["report", &dataset.path, &dataset.out, "-o", &page]).exits(0).says([told]);
    let html = fs::read_to_string(&page).unwrap();
    assert!(html.contains("Sequences without truth") && html.contains("<li>01</li>"));
    let chosen = ralf(["report", &dataset.path, &dataset.out, "-o", &page, "--sequence", "00"]).exits(0);
    assert!(!chosen.stderr.contains("has no truth"), "{}", chosen.stderr);
    let html = fs::read_to_string(&page).unwrap();
    assert!(!html.contains("for want of corrected labels"), "the other one is no part of the page");
    ralf(["evaluate", &dataset.out, "--truth", &dataset.path]).exits(0).says([told]);
    ralf(["evaluate", &dataset.out, "--truth", &dataset.path, "--json"]).exits(0).says([told]);
}

/// A report says how its labels are made again.
#[test]
fn the_settings_of_a_report_make_the_same_labels() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() });
    let [page, settings] = ["report.html", "again.toml"].map(|name| dataset.beside(name));
    let asked = ["--set", "lidar.beta=0.375", "--set", "corrections.radar_front.add_yaw_deg=0.25"];
    let label = |more: &[&str]| {
        Ran::of(&program().args(["label", &dataset.path, "-o", &dataset.out]).args(more).output().unwrap())
    };
    label(&asked).exits(0);
    ralf(["report", &dataset.path, &dataset.out, "-o", &page]).exits(0);
    let html = fs::read_to_string(&page).unwrap();
    let shown = html.split("All settings</summary><pre>").nth(1).unwrap().split("</pre>").next().unwrap();
    let text = shown.replace("&quot;", "\"").replace("&lt;", "<").replace("&gt;", ">").replace("&amp;", "&");
    assert!(text.contains("beta = 0.375"), "{text}");
    fs::write(&settings, text).unwrap();
    label(&["--config", &settings]).exits(0).says(["nothing to do"]);
}

/// Labels go on without a LiDAR scan that can't be read, and so do their pictures.
#[test]
fn a_lidar_scan_that_cannot_be_read_costs_a_picture_its_points_alone() {
    let dataset = Dataset::of(&Shape { scans: 3, ..Shape::default() }).with_camera(3);
    dataset.cut("lidar_top/000001.bin", 4);
    ralf(["label", &dataset.path, "-o", &dataset.out])
        .exits(0)
        .says(["labelled without: 00 lidar_top scan 1"]);
    let [page, picture] = ["report.html", "scan.png"].map(|name| dataset.beside(name));
    let told = "drawn without: 00 lidar_top scan 1: ";
    let report = || ralf(["report", &dataset.path, &dataset.out, "-o", &page]).exits(0);
    let said = report().says([told, "lidar_top/000001.bin", "rows of 4 float32"]);
    assert_eq!(said.stderr.matches(told).count(), 1, "{}", said.stderr);
    assert!(fs::read_to_string(&page).unwrap().contains(told));
    let plot = |more: &[&str]| {
        let asked = ["plot", &dataset.path, &dataset.out, "-o", &picture];
        Ran::of(&program().args(asked).args(more).output().unwrap()).exits(0)
    };
    plot(&["--scan", "1"]).says([told]);
    plot(&["--scan", "1", "--camera", "camera_front"]).says([told]);
    plot(&["--all"]).says([told]);
    assert!(!plot(&["--scan", "0"]).stderr.contains(told));
    let settings = dataset.beside("tuned.html");
    fs::write(&settings, "[lidar]\nbeta = 0.5\n").unwrap();
    ralf(["report", &dataset.path, &dataset.out, "-o", &settings]).exits(2).says(["which would be lost"]);
    let pdf = dataset.beside("report.pdf");
    ralf(["report", &dataset.path, &dataset.out, "-o", &pdf]).exits(2).says(["a name that ends in .html"]);
    assert!(fs::read_to_string(&settings).unwrap().starts_with("[lidar]"));
}
