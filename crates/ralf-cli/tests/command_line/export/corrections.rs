//! What a person said stands above what the machine found.

use super::{export, small};
use ralf_corrections::{FILE, Mark, ScanEdit, ScanKey, Store, Stroke, Who};
use std::fs;
use std::path::Path;

fn labels(path: &str, scan: usize) -> Vec<u32> {
    let bytes = fs::read(format!("{path}/sequences/00/labels/{scan:06}.label")).unwrap();
    bytes.as_chunks::<4>().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect()
}

#[test]
fn corrections_and_accepted_labels_are_exported() {
    let dataset = small();
    let before = export(&dataset, "semantickitti", "before", &[]);
    let [first, second] = [0, 1].map(|scan| labels(&before, scan));
    let mut store = Store::open(&Path::new(&dataset.out).join(FILE)).unwrap();
    let who = Who::named("ada");
    let detections = first.len() as u32;
    let edit = ScanEdit {
        radar: "radar_front".to_owned(),
        scan: 0,
        detections,
        content: None,
        base: 0,
        points: vec![2, 5],
    };
    store.apply(&Stroke { label: Some(10), scans: vec![edit], ..Stroke::of_sequence("00") }, &who).unwrap();
    // Accepted when the machine said the contrary.
    let key = ScanKey { sequence: "00".to_owned(), radar: "radar_front".to_owned(), scan: 1 };
    let accepted: Vec<u16> = second.iter().map(|label| if *label == 1 { 99 } else { 1 }).collect();
    store
        .mark(&Mark { key, content: None, base: 0, machine: accepted.clone(), reviewed: true }, &who)
        .unwrap();
    let after = export(&dataset, "semantickitti", "after", &[]);
    let mut expected = first;
    [2, 5].into_iter().for_each(|point: usize| expected[point] = 10);
    assert_eq!(labels(&after, 0), expected);
    assert_eq!(labels(&after, 1), accepted.into_iter().map(u32::from).collect::<Vec<_>>());
    assert_eq!(labels(&after, 2), labels(&before, 2));
}
