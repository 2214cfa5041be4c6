//! What lies beside and in an SQLite file.

use super::{Place, fixture};
use ralf_ros::container::Container;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What its recorder left where it was killed: the database, the log of changes and that log's index.
fn killed_recorder(folder: &Path) -> PathBuf {
    let [written, left] = ["written.db3", "left.db3"].map(|name| folder.join(name));
    std::fs::write(&written, fixture("db3/db3.db3")).unwrap();
    let on = rusqlite::Connection::open(&written).unwrap();
    on.pragma_update(None, "journal_mode", "WAL").unwrap();
    on.execute_batch(
        "INSERT INTO messages (topic_id, timestamp, data) SELECT topic_id, 5, data FROM messages LIMIT 3",
    )
    .unwrap();
    for ending in ["", "-wal", "-shm"] {
        let [from, to] = [&written, &left].map(|file| format!("{}{ending}", file.display()));
        std::fs::copy(from, to).unwrap();
    }
    drop(on);
    std::fs::remove_file(written).unwrap();
    left
}

/// The files of a folder, and what is in them.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let all = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    all.map(|file| (file.clone(), std::fs::read(file).unwrap())).collect()
}

#[test]
fn what_a_killed_recorder_left_is_read_with_its_log_and_nothing_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let file = killed_recorder(folder.path());
    let before = files(folder.path());
    assert_eq!(before.len(), 3);
    assert_eq!(Container::open(&file).unwrap().messages().len(), 14);
    assert!(files(folder.path()) == before);
    let [log, index] = ["-wal", "-shm"].map(|ending| format!("{}{ending}", file.display()));
    std::fs::remove_file(index).unwrap();
    let before = files(folder.path());
    let error = Container::open(&file).unwrap_err().to_string();
    assert!(
        error.contains("-wal") && error.contains("sqlite3 '") && error.contains("FROM messages'"),
        "{error}"
    );
    assert!(files(folder.path()) == before);
    // Written back, and in the same mode.
    let on = rusqlite::Connection::open(&file).unwrap();
    assert_eq!(on.query_row("SELECT count(*) FROM messages", [], |row| row.get(0)), Ok(14));
    drop(on);
    assert!(!Path::new(&log).exists());
    let before = files(folder.path());
    assert_eq!(Container::open(&file).unwrap().messages().len(), 14);
    assert!(files(folder.path()) == before && before.len() == 1);
}

#[test]
fn a_change_that_was_never_ended_is_not_taken_for_a_recording() {
    let folder = tempfile::tempdir().unwrap();
    let [written, left] = ["written.db3", "left.db3"].map(|name| folder.path().join(name));
    std::fs::write(&written, fixture("db3/db3.db3")).unwrap();
    let on = rusqlite::Connection::open(&written).unwrap();
    on.execute_batch("PRAGMA cache_size = 1; BEGIN; UPDATE messages SET data = zeroblob(100000)").unwrap();
    for ending in ["", "-journal"] {
        let [from, to] = [&written, &left].map(|file| format!("{}{ending}", file.display()));
        std::fs::copy(from, to).unwrap();
    }
    let error = Container::open(&left).unwrap_err().to_string();
    assert!(error.contains("-journal") && error.contains("sqlite3 '"), "{error}");
}

#[test]
fn a_view_in_the_place_of_a_table_is_refused() {
    let place = Place::new();
    for (table, columns) in [
        ("topics", "1 id, 2 name, 3 type, 4 serialization_format"),
        ("messages", "1 id, 1 topic_id, 2 timestamp"),
    ] {
        std::fs::write(&place.file, fixture("db3/db3.db3")).unwrap();
        let on = rusqlite::Connection::open(&place.file).unwrap();
        let view = format!("DROP TABLE {table}; CREATE VIEW {table} AS SELECT {columns} FROM sqlite_master");
        on.execute_batch(&view).unwrap();
        drop(on);
        let error = Container::open(&place.file).unwrap_err().to_string();
        assert!(error.contains(&format!("table `{table}`")) && error.contains("view"), "{error}");
    }
}

#[cfg(unix)]
#[test]
fn a_pipe_in_the_place_of_a_log_is_named() {
    let place = Place::new();
    let log = format!("{}-wal", place.file.display());
    assert!(std::process::Command::new("mkfifo").arg(&log).status().unwrap().success());
    let error = place.open(&fixture("db3/db3.db3")).unwrap_err().to_string();
    assert!(error.contains("recording-wal, found a named pipe"), "{error}");
}
