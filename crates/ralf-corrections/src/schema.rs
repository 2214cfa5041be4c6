//! The tables, and opening a file that has them.

use crate::error::{StoreError, WAIT_SECONDS, told};
use rusqlite::{Connection, ErrorCode, OpenFlags, TransactionBehavior};
use std::path::Path;
use std::time::Duration;

/// `PRAGMA application_id`: "RALF".
const APPLICATION: i32 = 0x5241_4C46;
/// `PRAGMA user_version`: of the tables below.
const VERSION: i32 = 1;

/// `event`: all that was ever done, in order; its number is what other windows wait for.
/// `stroke`: `applied` and `undone` name the event that did so last; both null: undone, and then overtaken by a new stroke.
/// `change`: what a stroke did. Of one detection the applied ones follow each other: the `after` of one is the next one's `before`.
/// `correction`: the `after` of each detection's last applied change, unless it is null.
const TABLES: &str = "
CREATE TABLE scan (
  id INTEGER PRIMARY KEY,
  sequence TEXT NOT NULL,
  radar TEXT NOT NULL,
  scan INTEGER NOT NULL,
  detections INTEGER NOT NULL,
  revision INTEGER NOT NULL DEFAULT 0,
  UNIQUE (sequence, radar, scan)
) STRICT;
CREATE TABLE event (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  at TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  kind TEXT NOT NULL,
  sequence TEXT NOT NULL,
  author TEXT NOT NULL,
  tab TEXT
) STRICT;
CREATE TABLE event_scan (
  event INTEGER NOT NULL REFERENCES event,
  scan INTEGER NOT NULL REFERENCES scan,
  revision INTEGER NOT NULL,
  PRIMARY KEY (scan, event)
) STRICT, WITHOUT ROWID;
CREATE INDEX event_scan_by_event ON event_scan (event);
CREATE TABLE stroke (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  made INTEGER NOT NULL REFERENCES event,
  sequence TEXT NOT NULL,
  author TEXT NOT NULL,
  tool TEXT NOT NULL,
  step TEXT,
  label INTEGER,
  applied INTEGER REFERENCES event,
  undone INTEGER REFERENCES event
) STRICT;
CREATE INDEX stroke_applied ON stroke (sequence, author, applied, id);
CREATE INDEX stroke_undone ON stroke (sequence, author, undone, id);
CREATE TABLE change (
  stroke INTEGER NOT NULL REFERENCES stroke,
  scan INTEGER NOT NULL REFERENCES scan,
  point INTEGER NOT NULL,
  before INTEGER,
  after INTEGER,
  PRIMARY KEY (stroke, scan, point)
) STRICT, WITHOUT ROWID;
CREATE INDEX change_by_point ON change (scan, point, stroke);
CREATE TABLE correction (
  scan INTEGER NOT NULL REFERENCES scan,
  point INTEGER NOT NULL,
  label INTEGER NOT NULL,
  PRIMARY KEY (scan, point)
) STRICT, WITHOUT ROWID;
CREATE TABLE review (
  scan INTEGER PRIMARY KEY REFERENCES scan,
  event INTEGER NOT NULL REFERENCES event,
  accepted BLOB NOT NULL
) STRICT;
";

/// Opens a store for writing; makes it where there is no file yet. Another program's file is left as it is.
pub(crate) fn open(file: &Path) -> Result<Connection, StoreError> {
    let mut connection = Connection::open(file).map_err(told(file))?;
    connection.busy_timeout(Duration::from_secs(WAIT_SECONDS)).map_err(told(file))?;
    if !is_empty(&connection).map_err(told(file))? {
        check(&connection, file)?;
    }
    create(&mut connection).map_err(told(file))?;
    check(&connection, file)?;
    Ok(connection)
}

/// Opens a store that exists, for reading.
pub(crate) fn open_read_only(file: &Path) -> Result<Connection, StoreError> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(file, flags).map_err(told(file))?;
    connection.busy_timeout(Duration::from_secs(WAIT_SECONDS)).map_err(told(file))?;
    match is_empty(&connection) {
        // SQLite wants to lay a file beside the store, and can't: on a disk that can only be read nobody writes to it, either.
        Err(error) if error.sqlite_error_code() == Some(ErrorCode::CannotOpen) && !has_journal(file) => {
            let connection = open_unchanging(file).map_err(told(file))?;
            check(&connection, file).map(|()| connection)
        }
        _ => check(&connection, file).map(|()| connection),
    }
}

/// Opens a store that nobody writes to.
fn open_unchanging(file: &Path) -> rusqlite::Result<Connection> {
    let escaped = file.to_string_lossy().replace('%', "%25").replace('?', "%3f").replace('#', "%23");
    let flags =
        OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_URI | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    Connection::open_with_flags(format!("file:{escaped}?immutable=1"), flags)
}

/// Whether there are edits that were not written back to the file itself.
fn has_journal(file: &Path) -> bool {
    let mut name = file.as_os_str().to_owned();
    name.push("-wal");
    Path::new(&name).metadata().is_ok_and(|journal| journal.len() > 0)
}

/// Makes the tables in a database that has none, and sets what belongs to a connection: every commit reaches the disk before
/// it is told.
fn create(connection: &mut Connection) -> rusqlite::Result<()> {
    connection.pragma_update(None, "journal_mode", "WAL")?;
    connection.pragma_update(None, "synchronous", "FULL")?;
    connection.pragma_update(None, "foreign_keys", "ON")?;
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    if is_empty(&transaction)? {
        transaction.execute_batch(TABLES)?;
        transaction.pragma_update(None, "application_id", APPLICATION)?;
        transaction.pragma_update(None, "user_version", VERSION)?;
    }
    transaction.commit()
}

fn is_empty(connection: &Connection) -> rusqlite::Result<bool> {
    let tables: i64 = connection.query_row("SELECT count(*) FROM sqlite_schema", [], |row| row.get(0))?;
    Ok(tables == 0 && number(connection, "application_id")? == 0)
}

/// Refuses other programs' databases, and those of another version.
fn check(connection: &Connection, file: &Path) -> Result<(), StoreError> {
    let application = number(connection, "application_id").map_err(told(file))?;
    if application != APPLICATION {
        let (expected, found) = (format!("{APPLICATION} (corrections)"), application.to_string());
        return Err(StoreError::content(file, "application_id", expected, found));
    }
    let version = number(connection, "user_version").map_err(told(file))?;
    if version != VERSION {
        let found = format!("{version}, of another version of the program");
        return Err(StoreError::content(file, "user_version", VERSION.to_string(), found));
    }
    Ok(())
}

fn number(connection: &Connection, pragma: &str) -> rusqlite::Result<i32> {
    connection.pragma_query_value(None, pragma, |row| row.get(0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_store_that_nobody_writes_to_is_read_without_a_file_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("50% #1?.sqlite");
        drop(open(&file).unwrap());
        assert!(!has_journal(&file));
        let connection = open_unchanging(&file).unwrap();
        check(&connection, &file).unwrap();
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn another_programs_file_is_left_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("corrections.sqlite");
        Connection::open(&file).unwrap().execute_batch("CREATE TABLE notes (text TEXT)").unwrap();
        let before = std::fs::read(&file).unwrap();
        assert!(open(&file).is_err() && open_read_only(&file).is_err());
        assert_eq!(std::fs::read(&file).unwrap(), before);
    }
}
