//! Opening a file that has the tables, and making one.

use crate::alone::{has_journal, or_the_journal, refuse_foreign_journal};
use crate::causes;
use crate::connect;
use crate::error::{StoreError, WAIT_SECONDS, told};
use crate::standing::check_standing;
use crate::tables::{self, APPLICATION, FIRST_VERSION, VERSION};
use ralf_files::database::uri;
use rusqlite::{Connection, ErrorCode, MAIN_DB};
use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::Duration;

/// Reading beside others who write.
const READ: &str = "mode=ro";

/// Opens a store for writing; makes it where there is no file yet. Another program's file, and a damaged one,
/// is left as it is.
pub(crate) fn open(file: &Path) -> Result<Connection, StoreError> {
    if !file.try_exists().map_err(StoreError::io(file))? {
        make(file)?;
    }
    refuse_empty(file)?;
    // Who may write and goes away again has the journal in the file, whatever was refused.
    let with_journal =
        has_journal(file).then(|| check(&connect::for_reading(file, READ)?, file)).transpose()?;
    let mut connection = connect::for_writing(file)?;
    let found = with_journal.map_or_else(|| check(&connection, file), Ok)?;
    prepare(&connection).map_err(told(file))?;
    check_writable(&connection, file)?;
    if found == FIRST_VERSION {
        tables::migrate(&mut connection).map_err(told(file))?;
    }
    causes::make_room(&connection).map_err(told(file))?;
    connection.pragma_update(None, "foreign_keys", "ON").map_err(told(file))?;
    Ok(connection)
}

/// Sets what belongs to a connection: every commit reaches the disk before it is told.
fn prepare(connection: &Connection) -> rusqlite::Result<()> {
    connection.busy_timeout(Duration::from_secs(WAIT_SECONDS))?;
    connection.pragma_update(None, "journal_mode", "WAL")?;
    connection.pragma_update(None, "synchronous", "FULL")
}

/// Refuses a store that can't be written. SQLite opens for reading what it may not write, and begins to write it as if
/// to read; of a journal that it may not write it tells when writing begins. Who finds somebody else writing may do so
/// later.
fn check_writable(connection: &Connection, file: &Path) -> Result<(), StoreError> {
    if connection.is_readonly(MAIN_DB).map_err(told(file))? {
        return Err(StoreError::ReadOnly { file: file.to_owned() });
    }
    let wait = |time| connection.busy_timeout(time).map_err(told(file));
    wait(Duration::ZERO)?;
    let begun = connection.execute_batch("BEGIN IMMEDIATE; ROLLBACK");
    wait(Duration::from_secs(WAIT_SECONDS))?;
    match begun {
        Err(error) if is_taken(&error) => Ok(()),
        begun => begun.map_err(told(file)),
    }
}

fn is_taken(error: &rusqlite::Error) -> bool {
    matches!(error.sqlite_error_code(), Some(ErrorCode::DatabaseBusy | ErrorCode::DatabaseLocked))
}

/// Makes a store beside its place and moves it there, so that it is never there by half. Somebody else's that
/// came first stays.
fn make(file: &Path) -> Result<(), StoreError> {
    static MADE: AtomicU32 = AtomicU32::new(0);
    let number = MADE.fetch_add(1, Ordering::Relaxed);
    let beside = suffixed(file, &format!(".{}-{number}.new", std::process::id()));
    let made = connect::for_making(&beside).and_then(|on| tables::create(&on)).map_err(told(file));
    let moved = made.and_then(|()| match fs::hard_link(&beside, file) {
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Ok(()),
        // Where the file system knows no links.
        Err(_) if !file.exists() => fs::rename(&beside, file).map_err(StoreError::io(file)),
        _ => Ok(()),
    });
    let _moved_already = fs::remove_file(&beside);
    moved
}

fn suffixed(file: &Path, suffix: &str) -> PathBuf {
    let mut name = file.as_os_str().to_owned();
    name.push(suffix);
    name.into()
}

/// A store that was opened for reading.
pub(crate) struct Opened {
    pub(crate) connection: Connection,
    /// Whether it tells what others write from now on.
    pub(crate) is_live: bool,
}

/// Opens a store that exists, for reading. One of the first version is read into memory as if it were of this one; that
/// where nobody can lay a file beside it as if it never changed.
pub(crate) fn open_read_only(file: &Path) -> Result<Opened, StoreError> {
    refuse_empty(file)?;
    let is_unchanging = is_unchanging(file)?;
    let option = if is_unchanging { "immutable=1" } else { READ };
    let connection = connect::for_reading(file, option)?;
    connection.busy_timeout(Duration::from_secs(WAIT_SECONDS)).map_err(told(file))?;
    let found = check(&connection, file)?;
    if found == VERSION {
        return Ok(Opened { connection, is_live: !is_unchanging });
    }
    let connection = in_memory(&uri(file, option)).map_err(told(file))?;
    Ok(Opened { connection, is_live: false })
}

/// A further connection to a store that is open already, for reading.
pub(crate) fn open_again(file: &Path) -> Result<Connection, StoreError> {
    let connection = connect::for_reading(file, READ)?;
    connection.busy_timeout(Duration::from_secs(WAIT_SECONDS)).map_err(told(file))?;
    Ok(connection)
}

/// A store that holds nothing and lies nowhere.
pub(crate) fn nowhere() -> rusqlite::Result<Connection> {
    let connection = connect::in_memory()?;
    tables::create(&connection).map(|()| connection)
}

fn in_memory(first: &str) -> rusqlite::Result<Connection> {
    let connection = connect::in_memory()?;
    connection.execute("ATTACH DATABASE ? AS first", [first])?;
    tables::take_over(&connection)?;
    connection.execute_batch("DETACH DATABASE first")?;
    Ok(connection)
}

/// Whether nobody writes to the store now, and this program can't: SQLite wants to lay a file beside it even for
/// reading, and can't there.
fn is_unchanging(file: &Path) -> Result<bool, StoreError> {
    let connection = connect::for_reading(file, READ)?;
    match tables::application(&connection) {
        Err(error) if cannot_lay_files(&error) => Ok(!has_journal(file)),
        _ => Ok(false),
    }
}

fn cannot_lay_files(error: &rusqlite::Error) -> bool {
    matches!(error.sqlite_error_code(), Some(ErrorCode::CannotOpen | ErrorCode::ReadOnly))
}

/// An empty file is no store: SQLite would take it for a new one, and what it held would be forgotten silently.
fn refuse_empty(file: &Path) -> Result<(), StoreError> {
    let length = file.metadata().map_err(StoreError::io(file))?.len();
    if length > 0 {
        return Ok(());
    }
    let expected = "an SQLite database with RALF's application id";
    Err(StoreError::content(
        file,
        "file",
        expected,
        "an empty file; restore it, or delete it if nothing was corrected yet",
    ))
}

/// Refuses what is no store, and one that is damaged or lies below another one's journal; returns its version.
fn check(connection: &Connection, file: &Path) -> Result<i32, StoreError> {
    let found = check_kind(connection, file).map_err(or_the_journal(file))?;
    refuse_foreign_journal(connection, file)?;
    let pages = check_pages(connection, file);
    pages.and_then(|()| check_standing(connection, file, found)).map_err(or_the_journal(file))?;
    Ok(found)
}

/// Refuses other programs' databases, those of another version, and those with programs in them; returns the version.
fn check_kind(connection: &Connection, file: &Path) -> Result<i32, StoreError> {
    let application = tables::application(connection).map_err(told(file))?;
    if application != APPLICATION {
        let (expected, found) = (format!("{APPLICATION} (corrections)"), application.to_string());
        return Err(StoreError::content(file, "application_id", expected, found));
    }
    let version = tables::version(connection).map_err(told(file))?;
    if ![FIRST_VERSION, VERSION].contains(&version) {
        let found = format!("{version}, of another version of the program");
        return Err(StoreError::content(file, "user_version", VERSION.to_string(), found));
    }
    connect::refuse_programs(connection, file)?;
    Ok(version)
}

/// Refuses a store with damaged pages, before anything is read from it or written to it.
fn check_pages(connection: &Connection, file: &Path) -> Result<(), StoreError> {
    let found: String =
        connection.query_row("PRAGMA integrity_check(1)", [], |row| row.get(0)).map_err(told(file))?;
    if found == "ok" {
        return Ok(());
    }
    Err(StoreError::content(
        file,
        "pages",
        "a whole SQLite database of corrections",
        format!("a damaged one ({found})"),
    ))
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
        let connection = connect::for_reading(&file, "immutable=1").unwrap();
        check(&connection, &file).unwrap();
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn another_programs_file_is_left_as_it_is() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("corrections.sqlite");
        Connection::open(&file).unwrap().execute_batch("CREATE TABLE notes (text TEXT)").unwrap();
        let before = fs::read(&file).unwrap();
        assert!(open(&file).is_err() && open_read_only(&file).is_err());
        assert_eq!(fs::read(&file).unwrap(), before);
    }

    #[test]
    fn several_may_make_it_at_once_and_one_remains() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("corrections.sqlite");
        std::thread::scope(|scope| {
            let opened: Vec<_> = (0..4).map(|_| scope.spawn(|| open(&file).map(drop))).collect();
            opened.into_iter().for_each(|opened| opened.join().unwrap().unwrap());
        });
        let names: Vec<_> =
            fs::read_dir(folder.path()).unwrap().map(|found| found.unwrap().file_name()).collect();
        assert_eq!(names, ["corrections.sqlite"]);
    }
}
