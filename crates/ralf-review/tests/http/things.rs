//! Things: what belongs together over a sequence, answered by one stroke.

use crate::support::{Out, SEQUENCE, Serving};
use serde_json::{Value, json};

/// A radar, a scan, and the thing of each of its detections.
type ThingsOfScan = (String, u64, Vec<u32>);

/// The most doubtful things, and the thing of each detection.
fn things(server: &Serving) -> (Vec<Value>, Vec<ThingsOfScan>) {
    let table = server.of_sequence("things").table();
    let ids = table.u32("thing");
    let mut begin = 0;
    let mut scans = Vec::new();
    for scan in table.header["scans"].as_array().unwrap() {
        let rows = scan["rows"].as_u64().unwrap() as usize;
        let of_scan = ids[begin..begin + rows].to_vec();
        scans.push((scan["radar"].as_str().unwrap().to_owned(), scan["scan"].as_u64().unwrap(), of_scan));
        begin += rows;
    }
    assert_eq!(begin, ids.len());
    (table.header["doubtful"].as_array().unwrap().clone(), scans)
}

/// The stroke that answers a thing, in all scans that it was seen in.
fn answer(thing: u64, scans: &[ThingsOfScan], label: u16) -> Value {
    let (mut base, mut points) = (Vec::new(), Vec::new());
    for (radar, scan, ids) in scans {
        let of_thing: Vec<usize> = (0..ids.len()).filter(|point| u64::from(ids[*point]) == thing).collect();
        if !of_thing.is_empty() {
            base.push(json!({ "radar": radar, "scan": scan, "revision": 0 }));
            points.push(json!({ "radar": radar, "scan": scan, "points": of_thing }));
        }
    }
    json!({ "tool": "thing", "protect": false, "label": label, "base": base, "points": points })
}

#[test]
fn a_thing_is_answered_by_one_stroke_and_leaves_the_queue() {
    let out = Out::new();
    let server = out.serve();
    let (doubtful, scans) = things(&server);
    let left = |thing: &Value| thing["expected_errors"].as_f64().unwrap();
    assert!(doubtful.is_sorted_by(|a, b| left(a) >= left(b)) && left(&doubtful[0]) > 0.0);
    let first = doubtful.iter().find(|thing| thing["scans"].as_u64() > Some(1)).unwrap();
    let number = first["thing"].as_u64().unwrap();
    let stroke = answer(number, &scans, 1);
    let parts = stroke["points"].as_array().unwrap();
    let detections: usize = parts.iter().map(|part| part["points"].as_array().unwrap().len()).sum();
    assert_eq!(first["scans"], json!(parts.len()));
    assert_eq!(first["detections"], json!(detections));
    let seen = |part: &&Value| part["radar"] == first["radar"] && part["scan"] == first["scan"];
    let seen = parts.iter().find(seen).unwrap();
    assert!(seen["points"].as_array().unwrap().contains(&first["point"]));

    let before = server.of_sequence("things/doubtful").json();
    let made = server.edit("POST", "strokes", &stroke, "one").json();
    assert_eq!((&made["changed"], &made["history"]["undo_depth"]), (&json!(detections), &json!(1)));
    let now = server.of_sequence("things/doubtful").json();
    let queued =
        |queue: &Value| queue["doubtful"].as_array().unwrap().iter().any(|one| one["thing"] == number);
    assert!(!queued(&now) && now["expected_errors"].as_f64() < before["expected_errors"].as_f64());

    // The program is started again: one step back takes all of it back.
    drop(server);
    let server = out.serve();
    assert!(!queued(&server.of_sequence("things/doubtful").json()));
    let undone = server.edit("POST", "undo", &json!({}), "one").json();
    assert_eq!((&undone["changed"], &undone["history"]["undo_depth"]), (&json!(detections), &json!(0)));
    let back = server.of_sequence("things/doubtful").json();
    assert_eq!(back["doubtful"], json!(doubtful), "{SEQUENCE}");
}

#[test]
fn what_was_said_of_some_of_a_thing_is_heard_for_the_rest() {
    let out = Out::new();
    let server = out.serve();
    let (doubtful, scans) = things(&server);
    let wanted =
        |thing: &&Value| thing["detections"].as_u64() > Some(3) && thing["plausible"] == thing["detections"];
    let thing = doubtful.iter().find(wanted).unwrap();
    let number = thing["thing"].as_u64().unwrap();
    let (radar, scan, ids) =
        scans.iter().find(|(_, _, ids)| ids.iter().any(|id| u64::from(*id) == number)).unwrap();
    let point = ids.iter().position(|id| u64::from(*id) == number).unwrap();
    let own = thing["expected_errors"].as_f64().unwrap() / thing["detections"].as_f64().unwrap();
    let each = |label: u16, revision: u64| {
        let base = json!([{ "radar": radar, "scan": scan, "revision": revision }]);
        let points = json!([{ "radar": radar, "scan": scan, "points": [point] }]);
        let stroke = json!({ "tool": "click", "label": label, "base": base, "points": points });
        server.edit("POST", "strokes", &stroke, "one").json();
        let now = server.of_sequence("things/doubtful").json();
        let found =
            now["doubtful"].as_array().unwrap().iter().find(|one| one["thing"] == number).unwrap().clone();
        assert_eq!(found["answered"], 1);
        found["expected_errors"].as_f64().unwrap() / (found["detections"].as_f64().unwrap() - 1.0)
    };
    assert!(each(1, 0) > own, "the machine was wrong: it may be so for the rest");
    assert!(each(99, 1) < own + 1e-9 + own / 3.0, "the machine was right");
}
