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
