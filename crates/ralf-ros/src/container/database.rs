//! A recording's database is opened so that nothing is run of it, and nothing is left beside it.

use super::error::ContainerError;
use ralf_files::Kind;
use ralf_files::database::{check_beside, has_changes_beside, log, uri};
use rusqlite::config::DbConfig;
use rusqlite::{Connection, ErrorCode, OpenFlags};
use std::io::Read;
use std::path::Path;

/// Where in a file the byte is that tells how it is read, and what it is where changes go to a log.
const READ_VERSION: (usize, u8) = (19, 2);

/// Opens a database for reading. It knows no views: one could take the place of a table, and never end.
pub(super) fn open(path: &Path) -> Result<Connection, ContainerError> {
    check_beside(path).map_err(ContainerError::io(path))?;
    let flags =
        OpenFlags::SQLITE_OPEN_READ_ONLY | OpenFlags::SQLITE_OPEN_URI | OpenFlags::SQLITE_OPEN_NO_MUTEX;
    let address = uri(path, option(path).map_err(ContainerError::io(path))?);
    Connection::open_with_flags(address, flags).and_then(guarded).map_err(refused(path, "file"))
}

fn guarded(connection: Connection) -> rusqlite::Result<Connection> {
    for setting in [DbConfig::SQLITE_DBCONFIG_ENABLE_VIEW, DbConfig::SQLITE_DBCONFIG_TRUSTED_SCHEMA] {
        connection.set_db_config(setting, false)?;
    }
    Ok(connection)
}

/// How it is read without a file beside it: where a log holds changes, by that and the index that lies there already;
/// where a log would be made, as what nobody writes to.
fn option(path: &Path) -> std::io::Result<&'static str> {
    let log = log(path);
    if log.metadata().is_ok_and(|log| log.len() > 0) {
        return Ok("mode=ro&readonly_shm=1");
    }
    let (place, logged) = READ_VERSION;
    let mut head = Vec::new();
    ralf_files::open(path, Kind::Stream)?.take(place as u64 + 1).read_to_end(&mut head)?;
    let is_logged = log.exists() || head.get(place) == Some(&logged);
    Ok(if is_logged { "immutable=1" } else { "mode=ro" })
}

/// For `map_err`: what SQLite said of this place in the file.
pub(super) fn refused(path: &Path, place: &str) -> impl FnOnce(rusqlite::Error) -> ContainerError {
    let (path, place) = (path.to_owned(), place.to_owned());
    move |error| {
        let wants_to_write =
            matches!(error.sqlite_error_code(), Some(ErrorCode::CannotOpen | ErrorCode::ReadOnly));
        if wants_to_write && has_changes_beside(&path) {
            let expected = "a recording that its recorder has ended";
            let found = format!(
                "changes beside it, in files -wal or -journal, that can't be read without writing them back: \
                 `sqlite3 '{}' 'SELECT count(*) FROM messages'` does that, in place or with a copy of all files",
                path.display()
            );
            return ContainerError::content(&path, "file", expected, found);
        }
        ContainerError::content(&path, place, "a recording of ROS 2 in SQLite", error.to_string())
    }
}
