//! What may happen to the file, and is noticed.
use ralf_corrections::{
    ContentHash, Mark, Outcome, Reader, ScanContent, ScanEdit, ScanKey, ScanVersion, Store, StoreError,
    Stroke, Who, read_layer,
};
use rusqlite::Connection;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

const DETECTIONS: u32 = 10;

struct Folder {
    folder: tempfile::TempDir,
    file: PathBuf,
}

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("corrections.sqlite");
        Self { folder, file }
    }

    fn names(&self) -> Vec<String> {
        let names = fs::read_dir(self.folder.path()).unwrap();
        let mut names: Vec<String> =
            names.map(|found| found.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

fn hash(byte: u8) -> Option<ContentHash> {
    Some(ContentHash::new([byte; 32]))
}

fn version(scan: u32, hash: Option<ContentHash>) -> ScanVersion {
    let key = ScanKey { sequence: "00".into(), radar: "front".into(), scan };
    ScanVersion { key, content: ScanContent { detections: DETECTIONS, hash } }
}

fn stroke(scan: u32, base: u64, content: Option<ContentHash>) -> Stroke {
    let edit =
        ScanEdit { radar: "front".into(), scan, detections: DETECTIONS, content, base, points: vec![1, 2] };
    Stroke { tool: "lasso".into(), label: Some(99), scans: vec![edit], ..Stroke::of_sequence("00") }
}

fn apply(store: &mut Store, scan: u32) -> Result<Outcome, StoreError> {
    store.apply(&stroke(scan, 0, hash(1)), &Who::named("ada"))
}

fn is_gone<T>(found: Result<T, StoreError>) -> bool {
    matches!(found, Err(StoreError::Gone { .. }))
}

#[test]
fn a_file_that_is_deleted_or_replaced_takes_no_edit() {
    let folder = Folder::new();
    let mut store = Store::open(&folder.file).unwrap();
    let reader = store.reader().unwrap();
    apply(&mut store, 1).unwrap();
    let away = folder.file.with_extension("away");
    fs::rename(&folder.file, &away).unwrap();
    let error = apply(&mut store, 2).unwrap_err();
    assert!(error.to_string().contains("found that it was deleted; nothing is saved any more"), "{error}");
    assert!(is_gone(reader.summaries("00")) && is_gone(store.undo("00", &Who::named("ada"))));
    assert!(is_gone(store.reader().map(drop)) || store.reader().is_err());
    fs::copy(&away, &folder.file).unwrap();
    let error = apply(&mut store, 2).unwrap_err();
    assert!(error.to_string().contains("found another file in its place"), "{error}");
    fs::rename(&away, &folder.file).unwrap();
    apply(&mut store, 2).unwrap();
    assert_eq!(reader.summaries("00").unwrap().len(), 2, "put back, it goes on");
}

#[test]
fn a_journal_that_is_deleted_is_noticed() {
    let folder = Folder::new();
    let mut store = Store::open(&folder.file).unwrap();
    apply(&mut store, 1).unwrap();
    fs::remove_file(format!("{}-wal", folder.file.display())).unwrap();
    assert!(is_gone(apply(&mut store, 2)));
}

#[test]
fn an_empty_file_is_no_new_store() {
    let folder = Folder::new();
    fs::write(&folder.file, "").unwrap();
    for error in [Store::open(&folder.file).unwrap_err(), Reader::open(&folder.file).unwrap_err()] {
        let error = error.to_string();
        assert!(
            error.contains("expected an SQLite database with RALF's application id, found an empty file"),
            "{error}"
        );
    }
    assert!(read_layer(&folder.file).is_err());
    assert_eq!(fs::read(&folder.file).unwrap(), []);
    assert_eq!(folder.names(), ["corrections.sqlite"]);
}

#[test]
fn a_store_with_triggers_or_views_is_refused_and_named() {
    for (program, told) in [
        (
            "CREATE TRIGGER undoes AFTER INSERT ON correction BEGIN DELETE FROM correction; END",
            "found the trigger `undoes`",
        ),
        (
            "CREATE VIEW endless AS WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) SELECT i FROM n",
            "found the view `endless`",
        ),
        (
            "DROP TABLE correction; CREATE VIEW correction AS SELECT 1 scan, 1 point, 1 label",
            "found the view `correction`",
        ),
    ] {
        let folder = Folder::new();
        apply(&mut Store::open(&folder.file).unwrap(), 1).unwrap();
        Connection::open(&folder.file).unwrap().execute_batch(program).unwrap();
        let before = fs::read(&folder.file).unwrap();
        for error in [
            Store::open(&folder.file).err(),
            Reader::open(&folder.file).err(),
            read_layer(&folder.file).err(),
        ] {
            let error = error.unwrap_or_else(|| panic!("{told}")).to_string();
            assert!(error.starts_with(&folder.file.display().to_string()) && error.contains(told), "{error}");
        }
        assert!(fs::read(&folder.file).unwrap() == before);
    }
}

#[test]
fn a_trigger_that_another_program_makes_meanwhile_is_never_run() {
    let folder = Folder::new();
    let mut store = Store::open(&folder.file).unwrap();
    apply(&mut store, 1).unwrap();
    let trigger = "CREATE TRIGGER undoes AFTER INSERT ON correction BEGIN DELETE FROM correction; END";
    Connection::open(&folder.file).unwrap().execute_batch(trigger).unwrap();
    apply(&mut store, 2).unwrap();
    assert_eq!(store.scan(&version(2, hash(1))).unwrap().corrections, [(1, 99), (2, 99)]);
}

#[cfg(unix)]
#[test]
fn a_pipe_in_the_place_of_a_journal_is_named() {
    for ending in ["-wal", "-journal", "-shm"] {
        let folder = Folder::new();
        drop(Store::open(&folder.file).unwrap());
        let pipe = format!("{}{ending}", folder.file.display());
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        for error in [Store::open(&folder.file).err(), Reader::open(&folder.file).err()] {
            let error = error.unwrap().to_string();
            let told = format!("corrections.sqlite{ending}, found a named pipe");
            assert!(error.contains("expected a regular file") && error.contains(&told), "{error}");
        }
    }
}

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

#[test]
fn the_file_alone_holds_everything_once_it_is_written_back() {
    let folder = Folder::new();
    let mut store = Store::open(&folder.file).unwrap();
    let _reader = store.reader().unwrap();
    apply(&mut store, 1).unwrap();
    store.write_back().unwrap();
    let copy = Folder::new();
    fs::copy(&folder.file, &copy.file).unwrap();
    let found = Store::open(&copy.file).unwrap().scan(&version(1, hash(1))).unwrap();
    assert_eq!(found.corrections, [(1, 99), (2, 99)]);
}

#[test]
fn reading_waits_for_nobody_who_writes() {
    let folder = Folder::new();
    let mut store = Store::open(&folder.file).unwrap();
    apply(&mut store, 1).unwrap();
    let reader = store.reader().unwrap();
    let other = rusqlite::Connection::open(&folder.file).unwrap();
    other.execute_batch("BEGIN IMMEDIATE").unwrap();
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| apply(&mut store, 2));
        let begin = Instant::now();
        while begin.elapsed() < Duration::from_millis(300) {
            assert_eq!(reader.summaries("00").unwrap().len(), 1);
        }
        other.execute_batch("COMMIT").unwrap();
        assert!(matches!(waiting.join().unwrap(), Ok(Outcome::Done(_))));
    });
    assert_eq!(reader.summaries("00").unwrap().len(), 2);
}

/// The tables of the first version, with a correction of two detections by ada, one taken back by her, and a mark.
const FIRST: &str = include_str!("first_version.sql");

#[test]
fn a_store_of_the_first_version_loses_nothing() {
    let folder = Folder::new();
    let first = || {
        let _none_yet = fs::remove_file(&folder.file);
        rusqlite::Connection::open(&folder.file).unwrap().execute_batch(FIRST).unwrap();
    };
    first();
    let before = fs::read(&folder.file).unwrap();
    let layer = read_layer(&folder.file).unwrap();
    let reader = Reader::open(&folder.file).unwrap();
    assert_eq!(reader.summaries("00").unwrap().len(), 2);
    assert_eq!(fs::read(&folder.file).unwrap(), before, "reading changes nothing");
    let mut store = Store::open(&folder.file).unwrap();
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
