//! Classes that the machine gave, and what tells them.

use crate::support::{LIDAR, Out, RADAR, SEQUENCE, Serving, label, stroke};
use ralf_data::result::{ClassSource, LabelledRun};
use ralf_data::{Corrections, ScanId, Settings, open, write_sequence};
use ralf_sim::presets;
use serde_json::json;
use std::fs;
use std::path::Path;
use std::sync::Arc;

#[test]
fn the_page_is_told_which_sensor_a_class_is_from_until_a_person_says_another() {
    let folder = tempfile::tempdir().unwrap();
    let sequence = presets::find("tiny").unwrap().sequences[0].simulate(3, 2).unwrap();
    let path = folder.path().join("recording");
    write_sequence(&sequence.with_segmentation(), &path, &|_| ()).unwrap();
    let (recording, out) = (open(&path, None).unwrap(), folder.path().join("out"));
    label(&recording, &out, &Settings::default());
    let run = LabelledRun::open(&out).unwrap().sequence(recording.sequences[0].as_ref()).unwrap();
    let tables = run.tables.tables(0).unwrap();
    let (_, rows) = tables.iter().find(|(key, _)| &*key.radar == RADAR && key.scan == 1).unwrap();
    let words = rows.get::<Arc<str>>("class_from").unwrap();
    let camera = ClassSource::ALL.iter().position(|source| *source == ClassSource::Camera).unwrap() as u8 + 1;
    let known: Vec<u8> = words.iter().map(|word| if &**word == "camera" { camera } else { 0 }).collect();
    let point = known.iter().position(|source| *source == camera).unwrap();

    let server = Serving::of_recording(recording, &out, "127.0.0.1", "ada").unwrap();
    let listed = server.get("/api/recording").json();
    assert_eq!(listed["class_sources"], json!(["", "lidar", "camera"]));
    let table = server.table(1);
    assert_eq!(table.u8("class_from"), known);
    let machine = table.u16("machine");
    assert!(machine.iter().zip(&known).all(|(id, source)| (*source == camera) != [1, 99].contains(id)));
    // A person's class is the label; what the machine said, and by what, stays beside it.
    let another = if machine[point] == 30 { 10 } else { 30 };
    assert_eq!(server.stroke(1, 0, Some(another), &[point as u32]).json()["changed"], 1);
    let table = server.table(1);
    assert_eq!((table.u16("label")[point], table.u8("corrected")[point]), (another, 1));
    assert_eq!((table.u16("machine"), table.u8("class_from")), (machine, known));
}

#[test]
fn without_segmentations_and_labelled_points_nothing_tells_a_class() {
    let out = Out::new();
    let server = out.serve();
    let scan = format!("/api/sequences/{SEQUENCE}/radars/{RADAR}/scans/1");
    assert!(server.get(&scan).table().u8("class_from").iter().all(|source| *source == 0));
}

/// Labels all points of a LiDAR's scans in a recording of the own layout.
fn label_points(recording: &Path, lidar: &str, id: u32) {
    let folder = recording.join("sequences").join(SEQUENCE).join(lidar);
    for entry in fs::read_dir(folder).unwrap() {
        let file = entry.unwrap().path();
        if file.extension().is_some_and(|ending| ending == "bin") {
            let points = fs::metadata(&file).unwrap().len() as usize / 16;
            fs::write(file.with_extension("label"), id.to_le_bytes().repeat(points)).unwrap();
        }
    }
}

#[test]
fn classes_that_semantickitti_lacks_are_accepted_and_found_again() {
    let folder = tempfile::tempdir().unwrap();
    let sequence = presets::find("tiny").unwrap().sequences[0].simulate(3, 2).unwrap();
    let (path, out) = (folder.path().join("recording"), folder.path().join("out"));
    write_sequence(&sequence, &path, &|_| ()).unwrap();
    label_points(&path, LIDAR, 7);
    let recording = open(&path, None).unwrap();
    label(&recording, &out, &Settings::default());
    let server = Serving::of_recording(recording, &out, "127.0.0.1", "ada").unwrap();
    let machine = server.table(1).u16("machine");
    let point = machine.iter().position(|id| *id == 7).unwrap() as u32;
    assert!(server.accept(1, 0).json()["reviewed"].is_object());
    assert_eq!(server.of_sequence("queue").json()["progress"]["reviewed"], 1);
    server.end();
    let scan = ScanId { sequence: SEQUENCE.into(), radar: RADAR.into(), scan: 1 };
    let recording = open(&path, None).unwrap();
    let corrections = Corrections::of_recording(&out, &recording).unwrap();
    let accepted = corrections.effective_labels(&scan, vec![Default::default(); machine.len()]).unwrap();
    assert_eq!(accepted.iter().map(|label| label.id).collect::<Vec<_>>(), machine);
    let server = Serving::of_recording(recording, &out, "127.0.0.1", "ada").unwrap();
    assert!(server.table(1).header["reviewed"].is_object());
    // Nobody sets such a class, but whoever accepted it may be found to be right.
    assert!(server.stroke(1, 0, Some(7), &[point]).refused(400).contains("an id of SemanticKITTI"));
    let mut settled = stroke(1, 0, Some(7), &[point]);
    settled["tool"] = json!("settle");
    settled["confirm"] = json!(true);
    assert_eq!(server.edit("POST", "strokes", &settled, "one").json()["changed"], 1);
}
