//! Pages and rows that are not what was written.

use super::{Folder, apply, hash, version};
use ralf_corrections::{Mark, Reader, Store, Who, read_layer};
use rusqlite::Connection;
use std::fs;
use std::path::Path;

/// A store of some pages, with nothing left in its journal.
fn filled(file: &Path) {
    let mut store = Store::open(file).unwrap();
    for scan in 0..60 {
        apply(&mut store, scan).unwrap();
    }
}

#[test]
fn damaged_pages_are_told_when_the_file_is_opened() {
    let folder = Folder::new();
    filled(&folder.file);
    let whole = fs::read(&folder.file).unwrap();
    let pages = whole.len() / 4096;
    assert!(pages > 8, "{pages}");
    for page in 1..pages {
        let mut damaged = whole.clone();
        damaged[page * 4096..page * 4096 + 64].fill(0xA5);
        fs::write(&folder.file, &damaged).unwrap();
        let error = Store::open(&folder.file).err();
        let error = error.unwrap_or_else(|| panic!("page {page} of {pages}")).to_string();
        assert!(error.contains("expected a whole SQLite database of corrections"), "{error}");
        assert!(Reader::open(&folder.file).is_err() && read_layer(&folder.file).is_err());
        assert_eq!(fs::read(&folder.file).unwrap(), damaged, "left as it is");
    }
    fs::write(&folder.file, &whole[..whole.len() / 2]).unwrap();
    assert!(Store::open(&folder.file).is_err());
}

/// Pages are whole in all of these, and most of what is read from them, too.
#[test]
fn rows_that_are_missing_and_marks_that_no_step_has_given_are_told_when_the_file_is_opened() {
    let marked = |detections: u16| Mark {
        key: version(1, hash(1)).key,
        content: hash(1),
        base: 1,
        machine: vec![99; usize::from(detections)],
        reviewed: true,
    };
    for (damage, told) in [
        ("DELETE FROM scan", "expected that all rows of scan are there that it names, found one missing"),
        ("DELETE FROM event", "expected that all rows of event are there that it names, found one missing"),
        ("DELETE FROM author", "expected that all rows of author are there that it names, found one missing"),
        ("DELETE FROM mark WHERE id < 3", "expected that all rows of mark are there that it names"),
        ("DELETE FROM stroke WHERE id = 1", "expected that all rows of stroke are there that it names"),
        ("UPDATE stroke SET label = 10", "stroke 1: expected changes to its label (10), found one to 99"),
        (
            "DELETE FROM review",
            "scan 00/front/1, mark of review: expected what the last step there says (1), found none",
        ),
        ("DELETE FROM review; DELETE FROM mark_change", "mark of review 1: expected a scan that has it"),
        (
            "INSERT INTO review VALUES (2, 1)",
            "scan 00/front/2, mark of review: expected what the last step there says (none), found 1",
        ),
    ] {
        let folder = Folder::new();
        let mut store = Store::open(&folder.file).unwrap();
        apply(&mut store, 1).unwrap();
        apply(&mut store, 2).unwrap();
        store.mark(&marked(10), &Who::named("ada")).unwrap();
        drop(store);
        drop(Store::open(&folder.file).unwrap());
        let on = Connection::open(&folder.file).unwrap();
        on.execute_batch(&format!("PRAGMA foreign_keys = OFF; {damage}")).unwrap();
        drop(on);
        let error = Store::open(&folder.file).err().unwrap_or_else(|| panic!("{damage}")).to_string();
        assert!(error.starts_with(&folder.file.display().to_string()) && error.contains(told), "{error}");
        assert!(Reader::open(&folder.file).is_err() && read_layer(&folder.file).is_err(), "{damage}");
    }
}

/// Its pages are whole, and its checks by the database say so.
#[test]
fn a_correction_that_no_stroke_has_given_is_told_when_the_file_is_opened() {
    for (damage, told) in [
        (
            "UPDATE correction SET label = 103 WHERE point = 2",
            "correction of detection 2: expected what the last stroke there says (99), found 103",
        ),
        (
            "UPDATE change SET after = 98 WHERE point = 1",
            "detection 1: expected what the last stroke there says (98), found 99",
        ),
        ("DELETE FROM correction WHERE point = 2", "(99), found none"),
        (
            "INSERT INTO correction VALUES (1, 7, 10)",
            "scan 00/front/1, correction of detection 7: expected what the last stroke there says (none), found 10",
        ),
    ] {
        let folder = Folder::new();
        let mut store = Store::open(&folder.file).unwrap();
        apply(&mut store, 1).unwrap();
        drop(store);
        drop(Store::open(&folder.file).unwrap());
        Connection::open(&folder.file).unwrap().execute_batch(damage).unwrap();
        let error = Store::open(&folder.file).unwrap_err().to_string();
        assert!(error.contains(told), "{error}");
        assert!(Reader::open(&folder.file).is_err() && read_layer(&folder.file).is_err(), "{damage}");
    }
}
