//! What a store's file holds by itself, its journal left out: by that a file is known again, whoever wrote it.
//!
//! SQLite lays any journal over any file, and what was put in a store's place would be lost below it.

use crate::connect;
use crate::error::StoreError;
use ralf_files::database::log;
use rusqlite::{Connection, Error, ErrorCode};
use std::path::Path;

/// A store's name, and the last thing that was done in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Held {
    pub(crate) store: String,
    pub(crate) event: i64,
}

/// What a file holds by itself.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Alone {
    /// A store.
    Store(Held),
    /// A store of the first version, which has no name, or no store at all.
    Nameless,
    /// Nobody knows: another program may be writing its journal back.
    Unreadable,
}

impl Alone {
    pub(crate) fn of(file: &Path) -> Self {
        let Ok(connection) = connect::for_reading(file, "immutable=1") else { return Self::Unreadable };
        match Held::of(&connection) {
            Ok(held) => Self::Store(held),
            // No such table, or no row in it; what is no database.
            Err(Error::SqlInputError { .. } | Error::QueryReturnedNoRows) => Self::Nameless,
            Err(error) => match error.sqlite_error_code() {
                Some(ErrorCode::NotADatabase | ErrorCode::Unknown) => Self::Nameless,
                _ => Self::Unreadable,
            },
        }
    }
}

impl Held {
    fn of(on: &Connection) -> rusqlite::Result<Self> {
        on.query_row("SELECT id, (SELECT coalesce(max(id), 0) FROM event) FROM store", [], |row| {
            Ok(Self { store: row.get(0)?, event: row.get(1)? })
        })
    }

    /// Whether it may have become the other one by edits.
    pub(crate) fn precedes(&self, later: &Self) -> bool {
        self.store == later.store && self.event <= later.event
    }
}

/// Whether edits lie beside a store that are not in it.
pub(crate) fn has_journal(file: &Path) -> bool {
    log(file).metadata().is_ok_and(|journal| journal.len() > 0)
}

/// Refuses a file whose journal is another store's, or was begun before what the file holds. `on` reads both.
pub(crate) fn refuse_foreign_journal(on: &Connection, file: &Path) -> Result<(), StoreError> {
    // The file first: who edits meanwhile adds to what both hold. Of what can't be read, whoever asks next tells.
    let alone = Alone::of(file);
    match (alone, Held::of(on)) {
        (Alone::Store(alone), Ok(both)) if !alone.precedes(&both) => {
            let expected = format!("that of store {}, of which the file is", alone.store);
            let found = format!("one of store {} up to edit {}{}", both.store, both.event, remedy(file));
            Err(StoreError::content(file, "journal", expected, found))
        }
        _ => Ok(()),
    }
}

/// What to do where a journal spoils a file that may be sound.
pub(crate) fn remedy(file: &Path) -> String {
    let log = log(file);
    let journal = log.file_name().unwrap_or_default().display();
    format!(
        "; where the file was put in another one's place, move {journal} away: it holds edits of that one"
    )
}

/// Adds to what is told of a damaged store that its journal may be what damages it.
pub(crate) fn or_the_journal(file: &Path) -> impl Fn(StoreError) -> StoreError {
    let remedy = if has_journal(file) { remedy(file) } else { String::new() };
    move |error| match error {
        StoreError::Content { file, place, expected, found } => {
            StoreError::Content { file, place, expected, found: found + &remedy }
        }
        error => error,
    }
}
