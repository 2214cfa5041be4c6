//! What must never happen to people's work: labels accepted unseen, edits lost or made twice, corrections on
//! other detections.

use crate::support::{Out, RADAR, SEQUENCE, Serving, label, recording, stroke};
use ralf_corrections::{FILE, ScanEdit, Store, Stroke, Who};
use ralf_data::Settings;
use ralf_data::{Corrections, open, scan_content};
use serde_json::{Value, json};
use std::fs;
use std::time::{Duration, Instant};

fn path(scan: usize) -> String {
    format!("radars/{RADAR}/scans/{scan}/reviewed")
}

#[test]
fn labels_that_changed_under_the_page_are_not_accepted() {
    let out = Out::new();
    let server = out.serve();
    let seen = server.table(1).header["stamp"].clone();
    // Labelled again with another threshold, while the page shows what was before.
    label(&recording(), out.path(), &Settings::from_toml("", &["fusion.threshold=1.0"]).unwrap());
    let mark = |stamp: &Value| json!({ "reviewed": true, "revision": 0, "stamp": stamp });
    let refused = server.edit("PUT", &path(1), &mark(&seen), "one");
    let sentence = refused.refused(409);
    assert!(sentence.contains("expected the labels that were on screen, found others"), "{sentence}");
    assert_eq!(serde_json::from_slice::<Value>(&refused.body).unwrap()["stale"], true);
    assert_eq!(server.table(1).header["reviewed"], json!(null));
    assert!(Corrections::open(out.path()).unwrap().is_empty());
    let now = server.table(1).header["stamp"].clone();
    assert_ne!(now, seen);
    server.edit("PUT", &path(1), &mark(&now), "one").json();
    let without = json!({ "reviewed": true, "revision": 0 });
    assert!(server.edit("PUT", &path(2), &without, "one").refused(400).contains("stamp"));
}

#[test]
fn undo_takes_a_mark_back() {
    let out = Out::new();
    let server = out.serve();
    assert_eq!(server.accept(1, 0).json()["history"]["undo"]["tool"], "reviewed");
    let undone = server.edit("POST", "undo", &json!({}), "one").json();
    assert_eq!((&undone["scans"][0]["reviewed"], &undone["changed"]), (&json!(null), &json!(1)));
    assert_eq!(server.of_sequence("queue").json()["progress"]["reviewed"], 0);
    let redone = server.edit("POST", "redo", &json!({}), "one").json();
    assert_eq!(redone["scans"][0]["reviewed"]["author"], "ada");
}

#[test]
fn an_edit_whose_answer_was_lost_may_be_asked_for_again() {
    let out = Out::new();
    let server = out.serve();
    let mut once = stroke(1, 0, Some(99), &[0, 1]);
    once["id"] = json!("stroke-0001");
    let first = server.edit("POST", "strokes", &once, "one").json();
    assert_eq!(server.edit("POST", "strokes", &once, "one").json(), first);
    server.stroke(1, 1, Some(1), &[2]).json();
    let undo = json!({ "id": "undo-0001" });
    let undone = server.edit("POST", "undo", &undo, "one").json();
    assert_eq!(server.edit("POST", "undo", &undo, "one").json(), undone);
    assert_eq!(server.of_sequence("history").json()["undo_depth"], 1);
    let stamp = server.table(1).header["stamp"].clone();
    let mark = json!({ "id": "mark-0001", "reviewed": true, "revision": 3, "stamp": stamp });
    let marked = server.edit("PUT", &path(1), &mark, "one").json();
    assert_eq!(server.edit("PUT", &path(1), &mark, "one").json(), marked);
    assert_eq!(server.of_sequence("history").json()["undo_depth"], 2);
    for id in ["short", "mark-0001", "stroke-0001"] {
        let error = server.edit("POST", "undo", &json!({ "id": id }), "one").refused(400);
        assert!(error.contains("id"), "{error}");
    }
    assert_eq!(server.of_sequence("history").json()["undo_depth"], 2);
}

#[test]
fn one_persons_undo_leaves_anothers_stroke() {
    let out = Out::new();
    let server = out.serve();
    server.edit_by("strokes", &stroke(1, 0, Some(99), &[0]), "browser-one").json();
    server.edit_by("strokes", &stroke(1, 1, Some(99), &[1]), "browser-two").json();
    let undone = server.edit_by("undo", &json!({}), "browser-one").json();
    assert_eq!(undone["scans"][0]["corrections"], json!([[1, 99]]));
    assert_eq!(server.edit_by("undo", &json!({}), "browser-one").json()["changed"], 0);
    server.edit_by("redo", &json!({}), "browser-one").json();
    server.edit_by("strokes", &stroke(1, 4, Some(1), &[0]), "browser-two").json();
    assert!(server.edit_by("undo", &json!({}), "browser-one").refused(409).contains("ada changed it"));
    let named = [("Content-Type", "application/json"), ("X-Ralf-Author", "b3"), ("X-Ralf-Name", "Zo%C3%AB")];
    let body = stroke(1, 5, Some(10), &[7]).to_string();
    let path = format!("/api/sequences/{SEQUENCE}/strokes");
    server.ask("POST", &path, &named, body.as_bytes()).json();
    assert!(server.stroke(1, 5, Some(1), &[7]).refused(409).contains("Zo\u{eb} changed it"));
}

#[test]
fn a_store_that_is_deleted_under_the_server_is_told() {
    let out = Out::new();
    let server = out.serve();
    server.stroke(1, 0, Some(99), &[0]).json();
    let file = out.path().join(FILE);
    let away = out.path().join("away.sqlite");
    fs::rename(&file, &away).unwrap();
    let gone = "found that it was deleted; nothing is saved any more";
    assert!(server.stroke(1, 1, Some(99), &[1]).refused(500).contains(gone));
    for asked in ["queue", "disagreements"] {
        assert!(server.of_sequence(asked).refused(500).contains(gone));
    }
    assert!(server.get("/api/people").refused(500).contains(gone));
    fs::rename(&away, &file).unwrap();
    server.stroke(1, 1, Some(99), &[1]).json();
}

#[test]
fn somebody_who_holds_the_store_keeps_nobody_from_reading() {
    let out = Out::new();
    let server = out.serve();
    server.stroke(1, 0, Some(99), &[0]).json();
    let other = rusqlite::Connection::open(out.path().join(FILE)).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    std::thread::scope(|scope| {
        let strokes: Vec<_> = (0..12)
            .map(|point| {
                scope.spawn({
                    let server = &server;
                    move || server.stroke(2, 0, Some(99), &[point]).status
                })
            })
            .collect();
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_millis(500) {
            assert_eq!(server.table(1).u8("corrected")[0], 1);
            assert_eq!(server.of_sequence("history").json()["undo_depth"], 1);
        }
        assert!(strokes.iter().all(|stroke| !stroke.is_finished()), "nothing is told before it is on disk");
        other.execute_batch("COMMIT").unwrap();
        let answers: Vec<u16> = strokes.into_iter().map(|stroke| stroke.join().unwrap()).collect();
        assert_eq!(answers.iter().filter(|status| **status == 200).count(), 1);
        assert_eq!(answers.iter().filter(|status| **status == 409).count(), 11);
    });
}

/// Turns the rows of a scan's file around by some, as if the recording had been made anew.
fn rotate(dataset: &std::path::Path, rows: usize) {
    let file = dataset.join("sequences").join(SEQUENCE).join(RADAR).join("000001.bin");
    let mut bytes = fs::read(&file).unwrap();
    let fields = recording().sequences[0].sequence().rig.radars[0].fields.len();
    bytes.rotate_left(rows * fields * 4);
    fs::write(&file, bytes).unwrap();
}

fn copy(from: &std::path::Path, to: &std::path::Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let (from, to) = (entry.as_ref().unwrap().path(), to.join(entry.unwrap().file_name()));
        if from.is_dir() { copy(&from, &to) } else { fs::copy(from, to).map(drop).unwrap() }
    }
}

#[test]
fn corrections_are_found_whatever_settings_make_of_values_and_those_of_earlier_versions_too() {
    let out = Out::new();
    let settings = Settings::from_toml("", &[&format!("corrections.{RADAR}.doppler_factor=-1")]).unwrap();
    let altered = || settings.correct(recording()).unwrap();
    let serve = |recording| Serving::of_recording(recording, out.path(), "127.0.0.1", "ada").unwrap();
    let server = serve(altered());
    server.stroke(1, 0, Some(10), &[3]).json();
    server.end();
    assert_eq!(Corrections::of_recording(out.path(), &recording()).unwrap().corrected_detections(), 1);
    let server = serve(recording());
    assert_eq!(server.stroke(1, 1, Some(10), &[4]).json()["changed"], 1);
    server.end();
    // As if an earlier version had written it.
    let content = scan_content(&altered().sequences[0].radar_scan(0, 2).unwrap());
    let detections = recording().sequences[0].radar_scan(0, 2).unwrap().len() as u32;
    let edit = ScanEdit {
        radar: RADAR.into(),
        scan: 2,
        detections,
        content: Some(content),
        base: 0,
        points: vec![5],
    };
    let earlier = Stroke { label: Some(10), scans: vec![edit], ..Stroke::of_sequence(SEQUENCE) };
    Store::open(&out.path().join(FILE)).unwrap().apply(&earlier, &Who::named("ada")).unwrap();
    let server = serve(altered());
    assert_eq!(server.table(1).u8("corrected").iter().sum::<u8>(), 2);
    assert_eq!(server.table(2).header["content"], json!(content.to_string()));
    assert_eq!(
        server.stroke(2, 1, Some(10), &[6]).json()["scans"][0]["corrections"],
        json!([[5, 10], [6, 10]])
    );
    let progress = server.of_sequence("queue").json()["progress"].clone();
    assert_eq!((&progress["orphaned_scans"], &progress["corrected_detections"]), (&json!(0), &json!(4)));
}

#[test]
fn corrections_of_other_detections_are_kept_shown_and_never_applied() {
    let folder = tempfile::tempdir().unwrap();
    let [dataset, out] = ["recording", "out"].map(|name| folder.path().join(name));
    copy(&recording().path, &dataset);
    let labelled = || {
        let recording = open(&dataset, None).unwrap();
        label(&recording, &out, &Settings::default());
        Serving::of_recording(recording, &out, "127.0.0.1", "ada").unwrap()
    };
    let server = labelled();
    let before = server.table(1);
    let content = scan_content(&recording().sequences[0].radar_scan(0, 1).unwrap());
    assert_eq!(before.header["content"], json!(content.to_string()));
    server.stroke(1, 0, Some(10), &[3]).json();
    server.accept(1, 1).json();
    // The page that was opened before still shows the detections that were there then.
    let mut late = stroke(1, 0, Some(99), &[5]);
    late["base"][0]["content"] = before.header["content"].clone();
    server.end();
    rotate(&dataset, 10);
    let server = labelled();
    let now = server.table(1);
    assert_eq!(now.f32("x")[0], before.f32("x")[10]);
    assert!(now.u8("corrected").iter().all(|corrected| *corrected == 0));
    assert_eq!((&now.header["revision"], &now.header["reviewed"]), (&json!(0), &json!(null)));
    // Nobody sees these steps, so nobody takes them back.
    assert_eq!(server.of_sequence("history").json()["undo"], json!(null));
    let undone = server.edit("POST", "undo", &json!({}), "one").json();
    assert_eq!((&undone["changed"], &undone["history"]["undo_depth"]), (&json!(0), &json!(0)));
    assert_eq!(now.u16("label"), now.u16("machine"));
    let queue = server.of_sequence("queue").json();
    assert_eq!(
        queue["progress"],
        json!({ "scans": 12, "reviewed": 0, "corrected_detections": 0, "orphaned_scans": 1 })
    );
    let rows = queue["scans"].as_array().unwrap();
    let row = rows.iter().find(|row| row["radar"] == RADAR && row["scan"] == 1).unwrap();
    assert_eq!((&row["orphaned"], &row["corrected"]), (&json!(2), &json!(0)));
    let refused = server.edit("POST", "strokes", &late, "one").refused(409);
    assert!(refused.contains("expected the detections that were on screen, found others"), "{refused}");
    server.stroke(1, 0, Some(99), &[0]).json();
    server.end();
    // With the detections come their corrections.
    rotate(&dataset, before.rows() - 10);
    let server = labelled();
    let back = server.table(1);
    assert_eq!((back.u16("label")[3], back.u8("corrected")[..4].to_vec()), (10, vec![0, 0, 0, 1]));
    assert_eq!(back.header["reviewed"]["author"], "ada");
}
