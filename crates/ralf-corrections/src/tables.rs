//! The tables of a store, and what a store of the first version becomes.

use rusqlite::{Connection, TransactionBehavior};

/// `PRAGMA application_id`: "RALF".
pub(crate) const APPLICATION: i32 = 0x5241_4C46;
/// `PRAGMA user_version`: the version of the tables below.
pub(crate) const VERSION: i32 = 2;
/// The version whose corrections did not know the content of their scans, and whose marks were no steps.
pub(crate) const FIRST_VERSION: i32 = 1;

/// - `store`: a name that no other store has.
/// - `scan`: a scan and what it held (a hash; empty: nobody knows). The same scan with another content has another row.
/// - `event`: all that was ever done, in order; its number is what other windows wait for.
/// - `stroke`: a step, or a part of one; `applied` and `undone` name the event that did so last; both null:
///   undone, and then overtaken by a new stroke.
/// - `change`: what a stroke did. The applied ones of a detection follow each other: the `after` of one is the
///   next one's `before`.
/// - `correction`: the `after` of each detection's last applied change, unless it is null.
/// - `mark`: marks of review with the labels that were accepted; `mark_change`: what a step did to them;
///   `review`: those that hold.
/// - `edit`: what came of edits with a name, so that none is made twice.
const TABLES: &str = "
CREATE TABLE store (id TEXT NOT NULL) STRICT;
INSERT INTO store (id) VALUES (lower(hex(randomblob(16))));
CREATE TABLE author (id TEXT PRIMARY KEY, name TEXT NOT NULL) STRICT, WITHOUT ROWID;
CREATE TABLE scan (
  id INTEGER PRIMARY KEY,
  sequence TEXT NOT NULL,
  radar TEXT NOT NULL,
  scan INTEGER NOT NULL,
  content BLOB NOT NULL,
  detections INTEGER NOT NULL,
  revision INTEGER NOT NULL DEFAULT 0,
  UNIQUE (sequence, radar, scan, content, detections)
) STRICT;
CREATE TABLE event (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  at TEXT NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ', 'now')),
  kind TEXT NOT NULL,
  sequence TEXT NOT NULL,
  author TEXT NOT NULL REFERENCES author,
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
  author TEXT NOT NULL REFERENCES author,
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
CREATE TABLE mark (
  id INTEGER PRIMARY KEY AUTOINCREMENT,
  event INTEGER NOT NULL REFERENCES event,
  accepted BLOB NOT NULL
) STRICT;
CREATE TABLE mark_change (
  stroke INTEGER NOT NULL REFERENCES stroke,
  scan INTEGER NOT NULL REFERENCES scan,
  before INTEGER REFERENCES mark,
  after INTEGER REFERENCES mark,
  PRIMARY KEY (stroke, scan)
) STRICT, WITHOUT ROWID;
CREATE TABLE review (
  scan INTEGER PRIMARY KEY REFERENCES scan,
  mark INTEGER NOT NULL REFERENCES mark
) STRICT;
CREATE TABLE edit (
  id TEXT PRIMARY KEY,
  kind TEXT NOT NULL,
  sequence TEXT NOT NULL,
  author TEXT NOT NULL REFERENCES author,
  event INTEGER REFERENCES event,
  stroke INTEGER REFERENCES stroke,
  changed INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
";

/// Fills the tables from those of the first version, which are called `{old}scan` and so on.
///
/// Its name is made of what it holds, so that its copies have it, too.
const TAKE_OVER: &str = "
UPDATE store SET id = coalesce(
  (SELECT 'first-' || lower(hex(at || ' ' || author || ' ' || sequence)) FROM {old}event ORDER BY id LIMIT 1), id);
INSERT INTO author (id, name) SELECT DISTINCT author, author FROM {old}event;
INSERT INTO scan (id, sequence, radar, scan, content, detections, revision)
  SELECT id, sequence, radar, scan, x'', detections, revision FROM {old}scan;
INSERT INTO event (id, at, kind, sequence, author, tab) SELECT id, at, kind, sequence, author, tab FROM {old}event;
INSERT INTO event_scan (event, scan, revision) SELECT event, scan, revision FROM {old}event_scan;
INSERT INTO stroke (id, made, sequence, author, tool, step, label, applied, undone)
  SELECT id, made, sequence, author, tool, step, label, applied, undone FROM {old}stroke;
INSERT INTO change (stroke, scan, point, before, after) SELECT stroke, scan, point, before, after FROM {old}change;
INSERT INTO correction (scan, point, label) SELECT scan, point, label FROM {old}correction;
INSERT INTO mark (id, event, accepted) SELECT scan, event, accepted FROM {old}review;
INSERT INTO review (scan, mark) SELECT scan, scan FROM {old}review;
";

/// The tables of the first version; and of its indices those whose names are used again.
const FIRST_TABLES: [&str; 7] = ["review", "correction", "change", "stroke", "event_scan", "event", "scan"];
const FIRST_INDICES: [&str; 4] =
    ["event_scan_by_event", "stroke_applied", "stroke_undone", "change_by_point"];

/// Makes the tables in a database that has none.
pub(crate) fn create(on: &Connection) -> rusqlite::Result<()> {
    on.execute_batch(TABLES)?;
    on.pragma_update(None, "application_id", APPLICATION)?;
    on.pragma_update(None, "user_version", VERSION)
}

/// Makes a store of the first version one of this version, whole or not at all.
pub(crate) fn migrate(connection: &mut Connection) -> rusqlite::Result<()> {
    connection.pragma_update(None, "foreign_keys", "OFF")?;
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    // Another program may have done so meanwhile.
    if version(&transaction)? == FIRST_VERSION {
        for index in FIRST_INDICES {
            transaction.execute_batch(&format!("DROP INDEX {index}"))?;
        }
        for table in FIRST_TABLES {
            transaction.execute_batch(&format!("ALTER TABLE {table} RENAME TO first_{table}"))?;
        }
        create(&transaction)?;
        transaction.execute_batch(&TAKE_OVER.replace("{old}", "first_"))?;
        for table in FIRST_TABLES {
            transaction.execute_batch(&format!("DROP TABLE first_{table}"))?;
        }
    }
    transaction.commit()
}

/// Makes the tables in an empty database, and fills them from a store of the first version that is attached as `first`.
pub(crate) fn take_over(on: &Connection) -> rusqlite::Result<()> {
    create(on)?;
    on.execute_batch(&TAKE_OVER.replace("{old}", "first."))
}

/// The version of the tables.
pub(crate) fn version(on: &Connection) -> rusqlite::Result<i32> {
    number(on, "user_version")
}

/// The program that the database belongs to.
pub(crate) fn application(on: &Connection) -> rusqlite::Result<i32> {
    number(on, "application_id")
}

fn number(on: &Connection, pragma: &str) -> rusqlite::Result<i32> {
    on.pragma_query_value(None, pragma, |row| row.get(0))
}
