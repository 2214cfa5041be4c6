//! What may happen to the file, and is noticed.

mod damage;
mod journal;
mod versions;

use ralf_corrections::{
    ContentHash, Outcome, Reader, ScanContent, ScanEdit, ScanKey, ScanVersion, Store, StoreError, Stroke,
    Who, read_layer,
};
use rusqlite::Connection;
use std::fs;
use std::path::PathBuf;
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
