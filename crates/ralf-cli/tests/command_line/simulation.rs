//! `ralf demo`, and its steps: `ralf simulate`, `label`, `evaluate`, and the report about it.

use crate::support::{Dataset, ralf, tree};
use std::fs;

#[test]
fn the_demonstration_shows_its_commands_a_table_and_a_page() {
    let folder = Dataset::new().beside("demo");
    let first = ralf(["demo", &folder]).exits(0).says(["$ ralf simulate", "$ ralf label", "$ ralf report"]);
    first.prints(["F1 plausible", "report.html in a browser"]);
    assert!(fs::read_to_string(format!("{folder}/report.html")).unwrap().contains("Labels of"));
    ralf(["demo", &folder]).exits(0).says(["is there already", "nothing to do"]);
}

#[test]
fn a_simulated_recording_is_labelled_evaluated_and_reported() {
    // Only for a folder of its own.
    let dataset = Dataset::new();
    let [made, again, out, page] =
        ["made", "again", "labels", "report.html"].map(|name| dataset.beside(name));
    ralf(["simulate", "-o", &made, "--preset", "tiny", "--scans", "4"]).exits(0).prints_nothing();
    ralf(["simulate", "-o", &again, "--preset", "tiny", "--scans", "4"]).exits(0);
    assert_eq!(tree(&made), tree(&again), "the same seed gives the same bytes");
    ralf(["simulate", "-o", &made, "--preset", "tiny"]).exits(1).says(["sequences"]);

    ralf(["label", &made, "-o", &out]).exits(0).prints(["radar_front", "camera_front"]);
    let scores = ralf(["evaluate", &out, "--truth", &made, "--json"]).exits(0).json();
    let accuracy = scores["overall"]["pooled"]["accuracy"].as_f64().unwrap();
    assert!((0.6..0.999).contains(&accuracy), "neither hopeless nor trivial: {accuracy}");

    ralf(["report", &made, &out, "-o", &page, "--scans-per-sequence", "1"]).exits(0);
    let html = fs::read_to_string(&page).unwrap();
    for part in ["Labels of", "side lobe", "inside building", "double bounce"] {
        assert!(html.contains(part), "the page lacks {part}");
    }
}
