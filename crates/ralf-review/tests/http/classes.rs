//! Classes that the machine gave, and what tells them.

use crate::support::{Out, RADAR, SEQUENCE, Serving, label};
use ralf_data::result::{ClassSource, LabelledRun};
use ralf_data::{Settings, open, write_sequence};
use ralf_sim::presets;
use serde_json::json;
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
