//! Edits: on disk when they are answered, undone and redone, and never silently overwritten.

use crate::support::{Out, RADAR, SEQUENCE, label, recording, stroke};
use ralf_data::Settings;
use ralf_data::{Comparison, Corrections, GroundTruth, Label, ScanId};
use serde_json::{Value, json};
use std::fs;
use std::time::{Duration, Instant};

fn scan_id(scan: u32) -> ScanId {
    ScanId { sequence: SEQUENCE.into(), radar: RADAR.into(), scan }
}

#[test]
fn a_stroke_is_on_disk_and_the_machines_labels_stay() {
    let out = Out::new();
    let server = out.serve();
    let file = scan_id(1).label_file(out.path());
    let before = fs::read(&file).unwrap();
    let answer = server.stroke(1, 0, Some(10), &[5, 3, 3]).json();
    assert_eq!(answer["changed"], 2);
    assert_eq!(
        answer["scans"],
        json!([{
            "radar": RADAR, "scan": 1, "revision": 1, "corrections": [[3, 10], [5, 10]], "causes": [], "reviewed": null
        }])
    );
    let history = &answer["history"];
    assert_eq!(
        (&history["undo_depth"], &history["redo_depth"], &history["redo"]),
        (&json!(1), &json!(0), &json!(null))
    );
    assert_eq!((&history["undo"]["tool"], &history["undo"]["label"]), (&json!("lasso"), &json!(10)));
    // As another program finds it, while the server runs.
    let corrections = Corrections::open(out.path()).unwrap();
    assert_eq!(
        (corrections.scans().collect::<Vec<_>>(), corrections.corrected_detections()),
        (vec![&scan_id(1)], 2)
    );
    let table = server.table(1);
    assert_eq!((table.u16("label")[3], table.u8("corrected")[3], table.u8("corrected")[4]), (10, 1, 0));
    assert_eq!(table.header["revision"], 1);
    assert_eq!(fs::read(&file).unwrap(), before);
    let queue = server.of_sequence("queue").json();
    assert_eq!(queue["progress"]["corrected_detections"], 2);
    let row =
        queue["scans"].as_array().unwrap().iter().find(|s| s["radar"] == RADAR && s["scan"] == 1).unwrap();
    assert_eq!(row["corrected"], 2);
}

#[test]
fn nothing_to_change_is_no_stroke_and_protected_detections_stay() {
    let out = Out::new();
    let server = out.serve();
    server.stroke(0, 0, Some(1), &[0]).json();
    let again = server.stroke(0, 1, Some(1), &[0]).json();
    assert_eq!((&again["stroke"], &again["changed"]), (&json!(null), &json!(0)));
    assert_eq!(again["scans"][0]["revision"], 1);
    let mut guarded = stroke(0, 1, Some(99), &[0, 1]);
    guarded["protect"] = json!(true);
    let answer = server.edit("POST", "strokes", &guarded, "one").json();
    assert_eq!(answer["scans"][0]["corrections"], json!([[0, 1], [1, 99]]));
    let answer = server.stroke(0, 2, None, &[0, 1, 2]).json();
    assert_eq!((&answer["changed"], &answer["scans"][0]["corrections"]), (&json!(2), &json!([])));
}

#[test]
fn undo_and_redo_outlive_the_server() {
    let out = Out::new();
    let server = out.serve();
    let machine = server.table(1).u16("label");
    server.stroke(1, 0, Some(99), &[0]).json();
    let mut first = stroke(1, 1, Some(1), &[1]);
    let mut second = stroke(1, 2, Some(99), &[2]);
    (first["group"], second["group"]) = (json!("halves"), json!("halves"));
    server.edit("POST", "strokes", &first, "one").json();
    assert_eq!(server.edit("POST", "strokes", &second, "one").json()["history"]["undo_depth"], 2);
    server.end();
    let server = out.serve();
    let undone = server.edit("POST", "undo", &json!({}), "two").json();
    assert_eq!((&undone["changed"], &undone["scans"][0]["corrections"]), (&json!(2), &json!([[0, 99]])));
    assert_eq!(server.edit("POST", "undo", &json!({}), "two").json()["history"]["redo_depth"], 2);
    assert_eq!(server.table(1).u16("label"), machine);
    let nothing = server.edit("POST", "undo", &json!({}), "two").json();
    assert_eq!(
        (&nothing["stroke"], &nothing["changed"], &nothing["scans"]),
        (&json!(null), &json!(0), &json!([]))
    );
    server.end();
    let server = out.serve();
    assert_eq!(server.of_sequence("history").json()["redo_depth"], 2);
    server.edit("POST", "redo", &json!({}), "two").json();
    let redone = server.edit("POST", "redo", &json!({}), "two").json();
    assert_eq!(redone["scans"][0]["corrections"], json!([[0, 99], [1, 1], [2, 99]]));
}

#[test]
fn neither_of_two_people_overwrites_the_other() {
    let out = Out::new();
    let [ada, bob] = ["ada", "bob"].map(|author| out.serve_for(author));
    ada.stroke(2, 0, Some(99), &[0, 1]).json();
    let refused = bob.stroke(2, 0, Some(1), &[1]);
    assert!(
        refused
            .refused(409)
            .contains("radar_front scan 2: expected no other edit, found that ada changed it")
    );
    let body: Value = serde_json::from_slice(&refused.body).unwrap();
    assert_eq!(
        (&body["conflict"]["author"], &body["conflict"]["tool"], &body["conflict"]["scan"]),
        (&json!("ada"), &json!("lasso"), &json!(2))
    );
    assert_eq!(body["scans"][0]["corrections"], json!([[0, 99], [1, 99]]));
    bob.stroke(2, 1, Some(1), &[1]).json();
    let refused = ada.edit("POST", "undo", &json!({}), "one").refused(409);
    assert!(refused.contains("bob"), "{refused}");
    assert!(ada.accept(2, 1).refused(409).contains("bob"));
    bob.edit("POST", "undo", &json!({}), "one").json();
    assert_eq!(ada.edit("POST", "undo", &json!({}), "one").json()["scans"][0]["corrections"], json!([]));
}

#[test]
fn what_was_accepted_outlives_labelling_again() {
    let out = Out::new();
    let server = out.serve();
    let before = server.table(1);
    let accepted = before.u16("label");
    server.stroke(1, 0, Some(10), &[0]).json();
    let path = format!("radars/{RADAR}/scans/1/reviewed");
    let marked = server.accept(1, 1).json();
    assert_eq!((&marked["reviewed"]["author"], &marked["progress"]["reviewed"]), (&json!("ada"), &json!(1)));
    let queue = server.of_sequence("queue").json();
    let last = queue["scans"].as_array().unwrap().last().unwrap();
    assert_eq!(
        (&last["radar"], &last["scan"], &last["reviewed"]["author"]),
        (&json!(RADAR), &json!(1), &json!("ada"))
    );
    // With a threshold that nothing reaches everything is an artifact.
    let settings = Settings::from_toml("", &["fusion.threshold=1.0"]).unwrap();
    label(&recording(), out.path(), &settings);
    let after = server.table(1);
    assert!(
        after.u16("machine").iter().filter(|id| **id == 1).count()
            > before.u16("machine").iter().filter(|id| **id == 1).count()
    );
    let labels = after.u16("label");
    assert_eq!((labels[0], &labels[1..]), (10, &accepted[1..]));
    assert_eq!(after.u8("corrected")[..2], [1, 0]);
    let truth = GroundTruth::merged(out.path(), Corrections::open(out.path()).unwrap()).unwrap();
    let ids: Vec<u16> = truth.labels(&scan_id(1)).unwrap().into_iter().map(|label| label.id).collect();
    assert_eq!(ids, labels);
    let comparison = Comparison::new(out.path(), &truth).unwrap();
    assert!(comparison.evaluation().overall.pooled.counts.tn < labels.len() as u64);
    let machine: Vec<Label> = after.u16("machine").into_iter().map(Label::of_class).collect();
    let exported = Corrections::open(out.path()).unwrap().effective_labels(&scan_id(1), machine).unwrap();
    assert_eq!(exported.into_iter().map(|label| label.id).collect::<Vec<_>>(), labels);
    let taken = server.edit("PUT", &path, &json!({ "reviewed": false, "revision": 1 }), "one").json();
    assert_eq!(taken["reviewed"], json!(null));
    assert_eq!(server.table(1).u16("label")[1..], after.u16("machine")[1..]);
}

#[test]
fn other_windows_hear_of_edits_at_once() {
    let out = Out::new();
    let server = out.serve();
    let counter = server.of_sequence("changes").json()["counter"].as_i64().unwrap();
    assert_eq!(counter, 0);
    let path = format!("/api/sequences/{SEQUENCE}/changes?since={counter}");
    let begin = Instant::now();
    let heard = std::thread::scope(|scope| {
        let waiting = scope.spawn(|| server.ask("GET", &path, &[("X-Ralf-Tab", "two")], &[]).json());
        std::thread::sleep(Duration::from_millis(100));
        server.stroke(1, 0, Some(99), &[0]).json();
        waiting.join().unwrap()
    });
    assert!(begin.elapsed() < Duration::from_secs(5));
    let change = json!({ "radar": RADAR, "scan": 1, "revision": 1, "author": "ada" });
    assert_eq!(heard, json!({ "counter": 1, "scans": [change] }));
    // Another program on the same corrections doesn't ring here, and is heard of all the same.
    let bob = out.serve_for("bob");
    let path = format!("/api/sequences/{SEQUENCE}/changes?since=1");
    let heard = std::thread::scope(|scope| {
        let waiting = scope.spawn(|| server.ask("GET", &path, &[("X-Ralf-Tab", "two")], &[]).json());
        bob.stroke(1, 1, Some(1), &[0]).json();
        waiting.join().unwrap()
    });
    assert_eq!(heard["scans"][0]["author"], "bob");
}

#[test]
fn malformed_edits_are_refused_and_leave_nothing() {
    let out = Out::new();
    let server = out.serve();
    let refused = |body: &Value, status: u16| server.edit("POST", "strokes", body, "one").refused(status);
    let whole = || stroke(1, 0, Some(99), &[0]);
    let without = |key: &str| {
        let mut body = whole();
        body.as_object_mut().unwrap().remove(key);
        body
    };
    let with = |key: &str, value: Value| {
        let mut body = whole();
        body[key] = value;
        body
    };
    for key in ["tool", "label", "base", "points"] {
        assert!(refused(&without(key), 400).contains(&format!("missing field `{key}`")), "{key}");
    }
    assert!(refused(&with("tol", json!("x")), 400).contains("unknown field `tol`"));
    assert!(refused(&with("label", json!(7)), 400).contains("expected an id of SemanticKITTI, found 7"));
    assert!(refused(&with("label", json!(70000)), 400).contains("70000"));
    assert!(refused(&with("tool", json!("")), 400).contains("tool"));
    assert!(refused(&with("group", json!("g".repeat(65))), 400).contains("group"));
    assert!(refused(&with("base", json!([])), 400).contains("expected the revision of radar_front scan 1"));
    let never = refused(&stroke(1, 7, Some(99), &[0]), 409);
    let expected = "radar_front scan 1: expected the revision that it has, 0, found a later one";
    assert!(never.starts_with(expected), "{never}");
    assert!(refused(&stroke(1, 0, Some(99), &[1_000_000]), 400).contains("expected detections below"));
    assert!(refused(&stroke(3, 0, Some(99), &[0]), 404).contains("below 3"));
    let twice =
        json!([{ "radar": RADAR, "scan": 1, "points": [0] }, { "radar": RADAR, "scan": 1, "points": [1] }]);
    assert!(refused(&with("points", twice), 400).contains("found it twice"));
    assert!(server.edit("POST", "undo", &json!({ "steps": 2 }), "one").refused(400).contains("steps"));
    let head = [("Content-Type", "application/json")];
    let path = format!("/api/sequences/{SEQUENCE}/strokes");
    assert!(server.ask("POST", &path, &head, b"{\"tool\": ").refused(400).contains("EOF"));
    assert!(
        server.ask("POST", &path, &[], whole().to_string().as_bytes()).refused(400).contains("Content-Type")
    );
    assert!(server.edit("POST", "strokes", &whole(), &"t".repeat(65)).refused(400).contains("x-ralf-tab"));
    assert!(Corrections::open(out.path()).unwrap().is_empty());
    assert_eq!(server.of_sequence("history").json()["undo_depth"], 0);
}

#[test]
fn a_cause_is_said_with_an_artifact_and_goes_with_its_stroke() {
    let out = Out::new();
    let server = out.serve();
    let recording = server.get("/api/recording").json();
    let known = recording["sayable_causes"].as_array().unwrap();
    let mirror = known.iter().position(|name| name == "mirror").unwrap() as u8;
    let stroke = |label: u16, cause: &str, revision: u64| {
        let base = json!([{ "radar": RADAR, "scan": 1, "revision": revision }]);
        let points = json!([{ "radar": RADAR, "scan": 1, "points": [2, 5] }]);
        json!({ "tool": "rule", "label": label, "cause": cause, "base": base, "points": points })
    };
    let plausible = server.edit("POST", "strokes", &stroke(99, "mirror", 0), "one");
    assert!(plausible.refused(400).ends_with("expected an artifact's where a cause is said, found 99"));
    let unknown = server.edit("POST", "strokes", &stroke(1, "moonlight", 0), "one");
    assert!(unknown.refused(400).contains("`moonlight`"));
    let made = server.edit("POST", "strokes", &stroke(1, "mirror", 0), "one").json();
    assert_eq!(made["scans"][0]["causes"], json!([[2, mirror], [5, mirror]]));
    // The same label again, for another reason: that is something else to say.
    let again = server.edit("POST", "strokes", &stroke(1, "road", 1), "one").json();
    assert_eq!(again["changed"], 2);
    server.edit("POST", "undo", &json!({}), "one").json();
    let now = server.table(1);
    let said: Vec<usize> = (0..now.rows()).filter(|row| now.u8("said_cause")[*row] != 0).collect();
    assert_eq!((said, now.u8("said_cause")[2]), (vec![2, 5], mirror));
    let past = server.of_sequence(&format!("radars/{RADAR}/scans/1/detections/2/said")).json();
    assert_eq!([&past["said"][0]["cause"], &past["said"][1]["cause"]], [&json!("road"), &json!("mirror")]);
    server.edit("POST", "undo", &json!({}), "one").json();
    assert!(server.table(1).u8("said_cause").iter().all(|cause| *cause == 0));
}
