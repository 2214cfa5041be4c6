//! Connections to a file that may come from elsewhere: nothing that it says is run.

use crate::error::{StoreError, told};
use ralf_files::database::{check_beside, uri};
use rusqlite::config::DbConfig;
use rusqlite::{Connection, OpenFlags, OptionalExtension};
use std::path::Path;

/// Opens a file that exists, for writing.
pub(crate) fn for_writing(file: &Path) -> Result<Connection, StoreError> {
    check_beside(file).map_err(StoreError::io(file))?;
    opened(file, "mode=rw", OpenFlags::SQLITE_OPEN_READ_WRITE).and_then(guarded).map_err(told(file))
}

/// Makes a file, to be written.
pub(crate) fn for_making(file: &Path) -> rusqlite::Result<Connection> {
    opened(file, "mode=rwc", OpenFlags::SQLITE_OPEN_READ_WRITE | OpenFlags::SQLITE_OPEN_CREATE)
}

/// By its URI: SQLite takes a path that begins with `file:` for one.
fn opened(file: &Path, option: &str, flags: OpenFlags) -> rusqlite::Result<Connection> {
    let flags = flags | OpenFlags::SQLITE_OPEN_URI | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    Connection::open_with_flags(uri(file, option), flags)
}

/// Opens a file that exists, for reading, with an option of SQLite's.
pub(crate) fn for_reading(file: &Path, option: &str) -> Result<Connection, StoreError> {
    check_beside(file).map_err(StoreError::io(file))?;
    opened(file, option, OpenFlags::SQLITE_OPEN_READ_ONLY).and_then(guarded).map_err(told(file))
}

/// A database that lies nowhere.
pub(crate) fn in_memory() -> rusqlite::Result<Connection> {
    Connection::open_in_memory().and_then(guarded)
}

/// Triggers and views are never run, also those that another program makes later.
fn guarded(connection: Connection) -> rusqlite::Result<Connection> {
    for (setting, value) in [
        (DbConfig::SQLITE_DBCONFIG_ENABLE_TRIGGER, false),
        (DbConfig::SQLITE_DBCONFIG_ENABLE_VIEW, false),
        (DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA, false),
        (DbConfig::SQLITE_DBCONFIG_DEFENSIVE, true),
    ] {
        connection.set_db_config(setting, value)?;
    }
    Ok(connection)
}

/// Refuses a store with triggers, which could undo every edit, or views, which could never end: no program of ours
/// makes either.
pub(crate) fn refuse_programs(connection: &Connection, file: &Path) -> Result<(), StoreError> {
    let query = "SELECT type || ' `' || name || '`' FROM sqlite_master
                 WHERE type IN ('trigger', 'view') ORDER BY type, name";
    let found: Option<String> =
        connection.query_row(query, [], |row| row.get(0)).optional().map_err(told(file))?;
    match found {
        None => Ok(()),
        Some(found) => {
            let expected = "tables and indices alone, as RALF makes them";
            Err(StoreError::content(file, "schema", expected, format!("the {found}")))
        }
    }
}
