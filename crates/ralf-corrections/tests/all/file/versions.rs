//! Stores of the first version, and scans that hold something else now.

use super::{DETECTIONS, Folder, apply, hash, stroke, version};
use ralf_corrections::{Mark, Outcome, Reader, ScanVersion, Store, Who, read_layer};
use rusqlite::Connection;
use std::fs;

/// The tables of the first version, with a correction of two detections by ada, one taken back by her, and a mark.
const FIRST: &str = include_str!("first_version.sql");

/// What steps that are taken back leave is as whole as the rest.
#[test]
fn marks_that_come_and_go_leave_a_whole_store() {
    for first_version in [false, true] {
        let folder = Folder::new();
        if first_version {
            Connection::open(&folder.file).unwrap().execute_batch(FIRST).unwrap();
        }
        let who = Who::named("ada");
        let steps = [Some(true), None, Some(true), Some(false), None, None, Some(false), Some(true), None];
        for reviewed in steps {
            let mut store = Store::open(&folder.file).unwrap();
            let ScanVersion { key, .. } = version(4, None);
            match reviewed {
                Some(reviewed) => {
                    let machine = vec![99; DETECTIONS as usize];
                    store.mark(&Mark { key, content: None, base: 0, machine, reviewed }, &who).unwrap()
                }
                None => store.undo("00", &who).unwrap(),
            };
        }
        drop(Store::open(&folder.file).unwrap());
    }
}

#[test]
fn a_store_of_the_first_version_loses_nothing() {
    let folder = Folder::new();
    let first = || {
        let _none_yet = fs::remove_file(&folder.file);
        rusqlite::Connection::open(&folder.file).unwrap().execute_batch(FIRST).unwrap();
    };
    first();
    let before = fs::read(&folder.file).unwrap();
    let copy = Folder::new();
    fs::write(&copy.file, &before).unwrap();
    let layer = read_layer(&folder.file).unwrap();
    let reader = Reader::open(&folder.file).unwrap();
    assert_eq!(reader.summaries("00").unwrap().len(), 2);
    assert_eq!(fs::read(&folder.file).unwrap(), before, "reading changes nothing");
    let mut store = Store::open(&folder.file).unwrap();
    let of_copy = Reader::open(&copy.file).unwrap().id().unwrap();
    assert_eq!([reader.id().unwrap(), store.id().unwrap()], [of_copy.clone(), of_copy], "copies are known");
    assert_eq!(read_layer(&folder.file).unwrap(), layer);
    let said: Vec<_> =
        layer.iter().map(|(key, said)| (key.scan, said.len(), said[0].corrections.clone())).collect();
    assert_eq!(said, [(3, 1, vec![(1, 99), (2, 99)]), (4, 1, vec![])]);
    assert_eq!(layer.values().next_back().unwrap()[0].accepted, Some(vec![99; 10]));
    let history = store.history("00", "ada").unwrap();
    assert_eq!((history.undo_depth, history.redo_depth), (1, 1));
    // The next edit notes the content; the same numbers of another content are not these any more.
    let now = version(3, hash(1));
    assert_eq!(store.scan(&now).unwrap().corrections, [(1, 99), (2, 99)]);
    assert!(matches!(store.apply(&stroke(3, 3, hash(1)), &Who::named("bob")).unwrap(), Outcome::Done(_)));
    let mut other = stroke(3, 3, hash(1));
    other.label = Some(1);
    assert!(matches!(store.apply(&other, &Who::named("bob")).unwrap(), Outcome::Done(_)));
    assert_eq!(store.scan(&version(3, hash(2))).unwrap().corrections, []);
    drop(store);
    assert_eq!(Store::open(&folder.file).unwrap().scan(&now).unwrap().corrections, [(1, 1), (2, 1)]);
}

#[test]
fn another_content_has_corrections_of_its_own_and_those_of_the_first_come_back_with_it() {
    let folder = Folder::new();
    let mut store = Store::open(&folder.file).unwrap();
    apply(&mut store, 1).unwrap();
    assert_eq!(store.scan(&version(1, hash(2))).unwrap().corrections, []);
    assert!(matches!(store.apply(&stroke(1, 0, hash(2)), &Who::named("ada")).unwrap(), Outcome::Done(_)));
    let summaries = store.summaries("00").unwrap();
    let contents: Vec<_> = summaries.iter().map(|said| said.content.hash).collect();
    assert_eq!(contents, [hash(1), hash(2)]);
    assert_eq!(store.scan(&version(1, hash(1))).unwrap().corrections, [(1, 99), (2, 99)]);
    assert_eq!(read_layer(&folder.file).unwrap().values().next().unwrap().len(), 2);
}
