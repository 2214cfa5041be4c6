//! The tables, and opening a file that has them.

use crate::error::{StoreError, WAIT_SECONDS, told};
use rusqlite::{Connection, OpenFlags};
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

/// Opens a store for writing; makes it where there is no file yet.
pub(crate) fn open(file: &Path) -> Result<Connection, StoreError> {
    let connection = Connection::open(file).map_err(told(file))?;
    prepare(connection, file).and_then(|mut connection| {
        create(&mut connection, file)?;
        check(&connection, file)?;
        Ok(connection)
    })
}

/// Opens a store that exists, for reading.
pub(crate) fn open_read_only(file: &Path) -> Result<Connection, StoreError> {
    let flags = OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let connection = Connection::open_with_flags(file, flags).map_err(told(file))?;
    connection.busy_timeout(Duration::from_secs(WAIT_SECONDS)).map_err(told(file))?;
    check(&connection, file)?;
    Ok(connection)
}

/// Every commit reaches the disk before it is told.
fn prepare(connection: Connection, file: &Path) -> Result<Connection, StoreError> {
    let set = || {
        connection.busy_timeout(Duration::from_secs(WAIT_SECONDS))?;
        connection.pragma_update(None, "journal_mode", "WAL")?;
        connection.pragma_update(None, "synchronous", "FULL")?;
        connection.pragma_update(None, "foreign_keys", "ON")
    };
    set().map_err(told(file))?;
    Ok(connection)
}

/// Makes the tables in a database that has none.
fn create(connection: &mut Connection, file: &Path) -> Result<(), StoreError> {
    let mut make = || {
        let transaction = connection.transaction_with_behavior(rusqlite::TransactionBehavior::Immediate)?;
        let tables: i64 =
            transaction.query_row("SELECT count(*) FROM sqlite_schema", [], |row| row.get(0))?;
        if tables == 0 && number(&transaction, "application_id")? == 0 {
            transaction.execute_batch(TABLES)?;
            transaction.pragma_update(None, "application_id", APPLICATION)?;
            transaction.pragma_update(None, "user_version", VERSION)?;
        }
        transaction.commit()
    };
    make().map_err(told(file))
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
