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

/// As rosbag2 tells for whom messages are: numbers until Humble, words since; nothing before Foxy.
#[test]
fn who_comes_later_gets_what_is_for_those_and_types_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("drive.db3");
    std::fs::write(&file, fixture("db3/db3.db3")).unwrap();
    let topic = |name: &str| {
        let container = Container::open(&file).unwrap();
        container.channels().iter().find(|channel| channel.topic == name).unwrap().clone()
    };
    assert!(topic("/tf_static").latched && !topic("/odom").latched);
    let on = rusqlite::Connection::open(&file).unwrap();
    let offered = |name: &str, profiles: &str| {
        on.execute("UPDATE topics SET offered_qos_profiles = ?1 WHERE name = ?2", [profiles, name]).unwrap();
    };
    for (profiles, latched) in [
        ("- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n", true),
        ("- history: keep_last\n  durability: transient_local\n", true),
        ("- history: 3\n  durability: 2\n- durability: 2\n", false),
        ("- durability: volatile\n", false),
    ] {
        offered("/odom", profiles);
        offered("/tf_static", profiles);
        assert_eq!((topic("/odom").latched, topic("/tf_static").latched), (latched, latched), "{profiles}");
    }
    let defined = "INSERT INTO message_definitions (topic_type, encoding, encoded_message_definition, \
                   type_description_hash) VALUES ('nav_msgs/msg/Odometry', 'ros2msg', 'Thing a', '')";
    on.execute("DELETE FROM message_definitions", []).unwrap();
    on.execute(defined, []).unwrap();
    let odom = topic("/odom");
    let told = (odom.schema.encoding.as_str(), odom.schema.text.as_slice());
    assert_eq!(told, ("ros2msg", b"Thing a".as_slice()));
    // What is wrong with a definition costs no more than that.
    on.execute("UPDATE message_definitions SET encoded_message_definition = x'ff00'", []).unwrap();
    assert!(topic("/odom").schema.text.is_empty());
    // What older recorders write has neither.
    on.execute_batch("DROP TABLE message_definitions; ALTER TABLE topics DROP COLUMN offered_qos_profiles")
        .unwrap();
    assert!(topic("/tf_static").latched && topic("/odom").schema.text.is_empty());
}
