//! A report tells of what is labelled, and names what isn't.

use crate::support::{Dataset, Shape, ralf};
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
