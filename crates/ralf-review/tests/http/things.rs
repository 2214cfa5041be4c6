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

/// The strokes that accept all changes of an opinion, as one step.
fn accepted(opinion: &Value) -> Vec<Value> {
    let stroke = |label: u16| {
        let mut points: std::collections::BTreeMap<(String, u64), Vec<Value>> =
            std::collections::BTreeMap::new();
        for change in opinion["changes"].as_array().unwrap().iter().filter(|change| change["label"] == label)
        {
            for part in change["points"].as_array().unwrap() {
                let scan = (part["radar"].as_str().unwrap().to_owned(), part["scan"].as_u64().unwrap());
                points.entry(scan).or_default().extend(part["points"].as_array().unwrap().clone());
            }
        }
        let points: Vec<Value> = points
            .into_iter()
            .map(|((radar, scan), points)| json!({ "radar": radar, "scan": scan, "points": points }))
            .collect();
        json!({ "tool": "opinion", "protect": true, "label": label, "group": "g", "points": points })
    };
    [1, 99].map(stroke).into_iter().filter(|stroke| stroke["points"] != json!([])).collect()
}

#[test]
fn an_opinion_changes_nothing_until_it_is_accepted_and_is_one_step_then() {
    let out = Out::new();
    let server = out.serve();
    let nothing = server.of_sequence("opinion").json();
    assert_eq!(nothing, json!({ "answered": 0, "changes": [], "base": [], "scans": null }));
    let (_, scans) = things(&server);
    // Somebody says that everything that any radar but the last one saw is an artifact.
    let last = &scans[scans.len() - 1].0;
    let said = || scans.iter().filter(|(radar, ..)| radar != last);
    let base: Vec<Value> =
        said().map(|(radar, scan, _)| json!({ "radar": radar, "scan": scan, "revision": 0 })).collect();
    let all = |ids: &Vec<u32>| (0..ids.len()).collect::<Vec<usize>>();
    let points: Vec<Value> = said()
        .map(|(radar, scan, ids)| json!({ "radar": radar, "scan": scan, "points": all(ids) }))
        .collect();
    let stroke = json!({ "tool": "lasso", "label": 1, "base": base, "points": points });
    server.edit("POST", "strokes", &stroke, "one").json();
    let before = server.of_sequence("progress").json();
    let opinion = server.of_sequence("opinion").json();
    assert_eq!(opinion["answered"], said().map(|(_, _, ids)| ids.len()).sum::<usize>());
    assert_eq!(server.of_sequence("opinion").json(), opinion, "the same answers give the same opinion");
    assert_eq!(server.of_sequence("progress").json(), before);
    let changes = opinion["changes"].as_array().unwrap();
    assert!(!changes.is_empty());
    for change in changes {
        let likely = change["probability"].as_f64().unwrap();
        assert!((0.5..=1.0).contains(&likely) && [1, 99].contains(&change["label"].as_u64().unwrap()));
        let is_said = |part: &Value| part["radar"] != *last;
        assert!(
            !change["points"].as_array().unwrap().iter().any(is_said),
            "of what was said nothing is proposed"
        );
    }
    let mut changed = 0;
    let mut base = opinion["base"].clone();
    for mut stroke in accepted(&opinion) {
        stroke["base"] = base.clone();
        let made = server.edit("POST", "strokes", &stroke, "one").json();
        changed += made["changed"].as_u64().unwrap();
        // The halves of one step meet in scans: the second rests on what the first led to.
        for now in made["scans"].as_array().unwrap() {
            let is_now = |one: &&mut Value| one["radar"] == now["radar"] && one["scan"] == now["scan"];
            base.as_array_mut().unwrap().iter_mut().find(is_now).unwrap()["revision"] =
                now["revision"].clone();
        }
    }
    let after = server.of_sequence("progress").json();
    assert_eq!(
        after["corrected_detections"].as_u64(),
        before["corrected_detections"].as_u64().map(|n| n + changed)
    );
    server.edit("POST", "undo", &json!({}), "one").json();
    assert_eq!(server.of_sequence("progress").json(), before);
}

/// The stroke that says of all of a kind that it is the other.
fn contradicted(asked: &Value) -> Value {
    let label = if asked["next"]["label"] == 1 { 99 } else { 1 };
    json!({ "tool": "kind", "protect": true, "confirm": true, "label": label, "base": asked["base"],
        "points": asked["next"]["points"] })
}

#[test]
fn a_kind_is_answered_by_one_stroke_over_the_whole_sequence_and_is_not_asked_about_again() {
    let out = Out::new();
    let server = out.serve();
    let before = server.of_sequence("progress").json();
    let asked = server.of_sequence("kinds").json();
    assert_eq!(server.of_sequence("kinds").json(), asked, "the same answers give the same question");
    assert_eq!(server.of_sequence("progress").json(), before, "asking changes nothing");
    let next = &asked["next"];
    let parts = next["points"].as_array().unwrap();
    let detections: usize = parts.iter().map(|part| part["points"].as_array().unwrap().len()).sum();
    assert_eq!(next["detections"], json!(detections));
    assert_eq!(asked["base"].as_array().unwrap().len(), parts.len());
    assert!(next["worth"].as_f64().unwrap() >= 1.0);
    // Each has the label that the question says it has.
    let (radar, scan) = (parts[0]["radar"].as_str().unwrap(), &parts[0]["scan"]);
    let table = server.of_sequence(&format!("radars/{radar}/scans/{scan}")).table();
    for point in parts[0]["points"].as_array().unwrap() {
        assert_eq!(
            u64::from(table.u16("label")[point.as_u64().unwrap() as usize]),
            next["label"].as_u64().unwrap()
        );
    }
    let made = server.edit("POST", "strokes", &contradicted(&asked), "one").json();
    assert_eq!(made["changed"], json!(detections));
    let now = server.of_sequence("kinds").json();
    assert_ne!(now["next"]["kind"], next["kind"]);
    // One step back takes all of it back, and the question is the same again.
    server.edit("POST", "undo", &json!({}), "one").json();
    assert_eq!(server.of_sequence("progress").json(), before);
    assert_eq!(server.of_sequence("kinds").json()["next"]["kind"], next["kind"]);
}

#[test]
fn kinds_that_were_passed_over_are_heard_and_others_are_refused() {
    let out = Out::new();
    let server = out.serve();
    let mut passed: Vec<String> = Vec::new();
    loop {
        let asked = server.of_sequence(&format!("kinds?passed={}", passed.join(","))).json();
        let Some(kind) = asked["next"]["kind"].as_str() else {
            assert_eq!((&asked["kinds"], &asked["base"]), (&json!(0), &json!([])));
            break;
        };
        assert!(!passed.iter().any(|other| other == kind), "{kind} is asked about again");
        passed.push(kind.to_owned());
    }
    assert!(!passed.is_empty());
    server.of_sequence("kinds?passed=weak").refused(400);
}
