//! People who label together: nobody sees what another said before both are through, and then they settle it.

use crate::support::{Out, RADAR, SEQUENCE, Serving, stroke};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;

/// The stroke that takes a side of a disagreement, as the page sends it.
fn settled(disagreements: &Value, side: &str) -> Value {
    let change = &disagreements["changes"][0];
    let scans: Vec<&Value> = change["points"].as_array().unwrap().iter().map(|part| &part["scan"]).collect();
    let base = disagreements["base"].as_array().unwrap();
    let base: Vec<&Value> = base.iter().filter(|base| scans.contains(&&base["scan"])).collect();
    let mut stroke = json!({ "tool": "settle", "protect": false, "confirm": true, "label": change[side],
        "base": base, "points": change["points"] });
    let cause = &change[format!("{side}_cause")];
    if cause.is_string() {
        stroke["cause"] = cause.clone();
    }
    stroke
}

/// The places of all disagreements of the first scan.
fn points(disagreements: &Value) -> Vec<u64> {
    let changes = disagreements["changes"].as_array().unwrap();
    let parts = changes.iter().flat_map(|change| change["points"].as_array().unwrap());
    let mut points: Vec<u64> = parts
        .flat_map(|part| part["points"].as_array().unwrap().iter().map(|p| p.as_u64().unwrap()))
        .collect();
    points.sort_unstable();
    points
}

#[test]
fn nobody_sees_what_another_said_before_both_are_through() {
    let out = Out::new();
    let first = out.serve();
    let machine = first.table(0).u16("machine");
    let plausible: Vec<u32> =
        (0..machine.len() as u32).filter(|point| machine[*point as usize] == 99).take(2).collect();
    first.stroke(0, 0, Some(1), &plausible).json();
    let second = Serving::second(out.path(), "bob").unwrap();
    let recording = second.get("/api/recording").json();
    assert_eq!((&recording["second"], &recording["author"]), (&json!("bob"), &json!("bob")));
    assert_ne!(recording["store"], first.get("/api/recording").json()["store"]);
    assert_eq!(second.table(0).u16("label"), machine, "bob doesn't see what ada said");
    second.accept(0, 0).json();
    // Ada isn't through: nothing of what bob said is told, and nothing that ada said to bob.
    let none = first.of_sequence("disagreements").json();
    assert_eq!((&none["changes"], &none["people"][0]["scans"]), (&json!([]), &json!(0)));
    assert!(second.of_sequence("disagreements").refused(403).contains("sees nobody else's labels"));
    first.accept(0, 1).json();
    let told = first.of_sequence("disagreements").json();
    assert_eq!(points(&told), plausible.iter().map(|point| u64::from(*point)).collect::<Vec<_>>());
    assert_eq!(told["people"][0]["agreement"]["overall"]["disagree"], 2);
    let sides = [&told["changes"][0]["first"], &told["changes"][0]["second"], &told["changes"][0]["by"]];
    assert_eq!(sides, [&json!(1), &json!(99), &json!("bob")]);
    let names = |server: &Serving| -> Vec<(Value, Value)> {
        let people = server.get("/api/people").json();
        people["days"]
            .as_array()
            .unwrap()
            .iter()
            .map(|day| (day["author"].clone(), day["second"].clone()))
            .collect()
    };
    assert_eq!(names(&first), [(json!("ada"), json!(false)), (json!("bob"), json!(true))]);
    assert_eq!(names(&second), [(json!("bob"), json!(true))]);
}

#[test]
fn a_side_is_taken_by_a_stroke_that_can_be_undone_and_agreement_stays() {
    let out = Out::new();
    let first = out.serve();
    let machine = first.table(0).u16("machine");
    let point = machine.iter().position(|label| *label == 99).unwrap() as u32;
    first.stroke(0, 0, Some(1), &[point]).json();
    first.accept(0, 1).json();
    Serving::second(out.path(), "bob").unwrap().accept(0, 0).json();
    let told = first.of_sequence("disagreements").json();
    for side in ["first", "second"] {
        let now = first.of_sequence("disagreements").json();
        let done = first.edit("POST", "strokes", &settled(&now, side), "one").json();
        assert_eq!(done["changed"], 1, "the first is right about what it said already, too");
        assert_eq!(json!(first.table(0).u16("label")[point as usize]), told["changes"][0][side]);
        let now = first.of_sequence("disagreements").json();
        assert_eq!((&now["changes"], &now["people"]), (&json!([]), &told["people"]));
        first.edit("POST", "undo", &json!({}), "one").json();
        assert_eq!(points(&first.of_sequence("disagreements").json()), [u64::from(point)]);
    }
    // Who rests on what was there before somebody else's stroke is told so.
    assert!(first.edit("POST", "strokes", &settled(&told, "first"), "one").refused(409).contains("ada"));
}

/// A stroke that says why detections are artifacts.
fn because(revision: u64, cause: &str, points: &[u32]) -> Value {
    let mut stroke = stroke(0, revision, Some(1), points);
    stroke["cause"] = json!(cause);
    stroke
}

#[test]
fn causes_of_which_both_said_one_are_compared_and_go_with_the_side_that_is_taken() {
    let out = Out::new();
    let [first, second] = [out.serve(), Serving::second(out.path(), "bob").unwrap()];
    // Of 0 they say different causes, of 1 the same, of 2 only one says one, of 3 the second alone says artifact.
    first.edit("POST", "strokes", &because(0, "mirror", &[0, 1]), "one").json();
    first.stroke(0, 1, Some(1), &[2]).json();
    first.stroke(0, 2, Some(99), &[3]).json();
    second.edit("POST", "strokes", &because(0, "road", &[0, 2, 3]), "one").json();
    second.edit("POST", "strokes", &because(1, "mirror", &[1]), "one").json();
    first.accept(0, 3).json();
    second.accept(0, 2).json();
    let side = |change: &Value, side: &str| {
        (change[side].as_u64().unwrap(), change[format!("{side}_cause")].as_str().map(str::to_owned))
    };
    let told = |server: &Serving| -> Vec<_> {
        let told = server.of_sequence("disagreements").json();
        let changes = told["changes"].as_array().unwrap();
        changes
            .iter()
            .map(|change| {
                (side(change, "first"), side(change, "second"), change["points"][0]["points"].clone())
            })
            .collect()
    };
    let (mirror, road) = ((1, Some("mirror".to_owned())), (1, Some("road".to_owned())));
    let about_causes = (mirror, road.clone(), json!([0]));
    let before = [((99, None), road, json!([3])), about_causes.clone()];
    assert_eq!(told(&first), before, "those about plausibility first, those about causes last");
    let sayable = first.get("/api/recording").json()["sayable_causes"].clone();
    let cause_of = |point: usize| sayable[usize::from(first.table(0).u8("said_cause")[point])].clone();
    let settle = |side: &str| {
        let now = first.of_sequence("disagreements").json();
        first.edit("POST", "strokes", &settled(&now, side), "one").json();
    };
    settle("second");
    assert_eq!((first.table(0).u16("label")[3], cause_of(3)), (1, json!("road")));
    assert_eq!(told(&first), [about_causes]);
    settle("second");
    assert_eq!((first.table(0).u16("label")[0], cause_of(0)), (1, json!("road")));
    assert_eq!(told(&first), []);
    for _ in 0..2 {
        first.edit("POST", "undo", &json!({}), "one").json();
    }
    assert_eq!((told(&first), cause_of(0)), (before.to_vec(), json!("mirror")));
    settle("first");
    settle("first");
    assert_eq!((cause_of(0), cause_of(3), told(&first)), (json!("mirror"), json!(""), Vec::new()));
}

#[test]
fn what_was_said_of_a_detection_and_of_its_thing_is_told_with_who_and_when() {
    let out = Out::new();
    let server = out.serve();
    server.stroke(0, 0, Some(1), &[0, 1]).json();
    server.stroke(0, 1, Some(10), &[0]).json();
    server.edit("POST", "undo", &json!({}), "one").json();
    server.accept(0, 3).json();
    let said = |path: &str| server.of_sequence(&format!("radars/{RADAR}/scans/0/detections/{path}"));
    let found = said("0/said").json();
    let told: Vec<(&Value, &Value, &Value)> = found["said"]
        .as_array()
        .unwrap()
        .iter()
        .map(|one| (&one["tool"], &one["label"], &one["holds"]))
        .collect();
    let (lasso, yes, no) = (json!("lasso"), json!(true), json!(false));
    assert_eq!(
        told,
        [(&json!("reviewed"), &Value::Null, &yes), (&lasso, &json!(10), &no), (&lasso, &json!(1), &yes)]
    );
    assert!(
        found["said"].as_array().unwrap().iter().all(|one| one["author"] == "ada" && one["at"].is_string())
    );
    assert_eq!(found["detections"], 1);
    // Of the thing at least as much was said.
    let things = server.of_sequence("things").table().u32("thing");
    let thing = said("0/said?thing=true").json();
    let scans = server.of_sequence("things").table().header["scans"].clone();
    let row: u64 = scans
        .as_array()
        .unwrap()
        .iter()
        .take_while(|scan| scan["radar"] != RADAR || scan["scan"] != 0)
        .map(|scan| scan["rows"].as_u64().unwrap())
        .sum();
    let number = things[row as usize];
    assert_eq!(thing["detections"], things.iter().filter(|other| **other == number).count());
    assert_eq!(thing["said"].as_array().unwrap().len(), 3);
    assert!(said("100000/said").refused(404).contains("detection: expected a number below"));
}

/// A thing that was seen in none of the scans that were dealt is no question, and what was said beyond them by an answer
/// about a thing is not compared.
#[test]
fn things_are_asked_about_and_agreement_counted_as_far_as_scans_were_dealt() {
    let out = Out::new();
    let team =
        format!("[ada]\nsequences = [\"{SEQUENCE}\"]\n[bob]\ntwice = [\"{SEQUENCE}/{RADAR}/000001\"]\n");
    fs::write(out.path().join("team.toml"), team).unwrap();
    let (first, second) = (out.serve(), Serving::second(out.path(), "bob").unwrap());
    let doubtful = |server: &Serving| {
        let told = server.of_sequence("things/doubtful").json();
        let things = told["doubtful"].as_array().unwrap().iter();
        things.map(|thing| thing["thing"].as_u64().unwrap()).collect::<Vec<_>>()
    };
    let table = second.of_sequence("things").table();
    let (mut at, mut seen) = (0, BTreeSet::new());
    for scan in table.header["scans"].as_array().unwrap() {
        let rows = at..at + scan["rows"].as_u64().unwrap() as usize;
        at = rows.end;
        if scan["radar"] == RADAR && scan["scan"] == 1 {
            seen.extend(table.u32("thing")[rows].iter().map(|thing| u64::from(*thing)));
        }
    }
    let asked = doubtful(&second);
    assert!(!asked.is_empty() && asked.iter().all(|thing| seen.contains(thing)));
    assert!(doubtful(&first).iter().any(|thing| !seen.contains(thing)));
    for server in [&first, &second] {
        (0..2).for_each(|scan| drop(server.accept(scan, 0).json()));
    }
    let told = first.of_sequence("disagreements").json();
    assert_eq!((&told["people"][0]["scans"], &told["waiting"]), (&json!(1), &json!(0)));
    assert_eq!(told["people"][0]["left_out"], 1, "who was not asked is told that it doesn't count");
}

#[test]
fn who_labels_a_second_time_has_those_scans_in_the_queue_that_were_dealt() {
    let out = Out::new();
    // The other sequence isn't labelled at the moment.
    let team = format!(
        "[ada]\nsequences = [\"{SEQUENCE}\", \"later\"]\n[bob]\ntwice = [\"{SEQUENCE}/{RADAR}/000001\", \"later/{RADAR}/000001\"]\n"
    );
    fs::write(out.path().join("team.toml"), team).unwrap();
    let (first, second) = (out.serve(), Serving::second(out.path(), "bob").unwrap());
    let recording = first.get("/api/recording").json();
    assert_eq!(
        (&recording["people"], &recording["sequences"][0]["assigned"]),
        (&json!(["ada", "bob"]), &json!("ada"))
    );
    assert!(first.of_sequence("queue").json()["scans"].as_array().unwrap().len() > 1);
    let queue = second.of_sequence("queue").json();
    let scans: Vec<(&Value, &Value)> =
        queue["scans"].as_array().unwrap().iter().map(|scan| (&scan["radar"], &scan["scan"])).collect();
    assert_eq!(scans, [(&json!(RADAR), &json!(1))]);
    second.accept(0, 0).json();
    let progress = second.of_sequence("progress").json();
    assert_eq!(
        (&queue["progress"]["scans"], &progress["scans"], &progress["reviewed"]),
        (&json!(1), &json!(1), &json!(0))
    );
    assert_eq!(first.of_sequence("disagreements").json()["waiting"], 1);
    for server in [&first, &second] {
        server.accept(1, 0).json();
    }
    assert_eq!(first.of_sequence("disagreements").json()["waiting"], 0);
    for known in ["bob", " bob"] {
        let server = Serving::second(out.path(), known).unwrap();
        assert_eq!(server.get("/api/recording").json()["author"], "bob");
    }
    for unknown in ["bbo", "Bob"] {
        let told = Serving::second(out.path(), unknown).err().unwrap().to_string();
        assert!(told.contains("expected one of ada, bob, found `"), "{told}");
    }
    let own = Serving::second(out.path(), "ada").unwrap();
    assert_eq!(own.of_sequence("queue").json()["scans"], json!([]), "the sequence is ada's own");
    let without = format!("[ada]\nsequences = [\"{SEQUENCE}\"]\n[bob]\n");
    fs::write(out.path().join("team.toml"), without).unwrap();
    let (first, second) = (out.serve(), Serving::second(out.path(), "bob").unwrap());
    let scans = |server: &Serving| server.of_sequence("queue").json()["progress"]["scans"].clone();
    assert_eq!(scans(&second), scans(&first), "bob was dealt none, and may choose");
    assert_eq!(first.of_sequence("disagreements").json()["waiting"], Value::Null);
    fs::write(out.path().join("team.toml"), "ada = 1").unwrap();
    assert!(Serving::second(out.path(), "bob").err().unwrap().to_string().contains("team.toml"));
    fs::remove_file(out.path().join("team.toml")).unwrap();
    assert!(
        Serving::second(out.path(), "../bob")
            .err()
            .unwrap()
            .to_string()
            .contains("a name that a file can have")
    );
}
