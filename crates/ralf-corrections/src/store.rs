//! The open store, to be written to.

use crate::conflict::Attempt;
use crate::error::{StoreError, WAIT_SECONDS, told};
use crate::identity::Identity;
use crate::outcome::Outcome;
use crate::reader::Reader;
use crate::schema;
use rusqlite::config::DbConfig;
use rusqlite::{Connection, Transaction, TransactionBehavior};
use std::ops::Deref;
use std::path::Path;
use std::time::Duration;

/// The corrections of one output folder. Several programs may have it open at once. It is a [`Reader`], too.
#[derive(Debug)]
pub struct Store(Reader);

impl Deref for Store {
    type Target = Reader;

    fn deref(&self) -> &Reader {
        &self.0
    }
}

/// What is closed last writes its journal back, into whatever lies there.
impl Drop for Store {
    fn drop(&mut self) {
        if self.0.check_there().is_err() {
            let _journal_stays =
                self.0.connection.set_db_config(DbConfig::SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, true);
        }
    }
}

impl Store {
    /// Opens a store; makes it where there is no such file yet. A store of the first version becomes one of
    /// this version.
    ///
    /// # Errors
    /// A file that is no store, is empty or damaged, or is of another version; one that can't be written, or
    /// that is locked.
    pub fn open(file: &Path) -> Result<Self, StoreError> {
        let connection = schema::open(file)?;
        // The journal lies there from the first reading on.
        connection.query_row("SELECT id FROM store", [], |_| Ok(())).map_err(told(file))?;
        let identity = Some(Identity::of_store(file)?);
        Ok(Self(Reader { connection, file: file.to_owned(), identity, snapshot: None }))
    }

    /// A further connection to the same store: what is read through it waits for no edit.
    ///
    /// # Errors
    /// A file that is not there any more; see [`StoreError`].
    pub fn reader(&self) -> Result<Reader, StoreError> {
        let connection = schema::open_again(self.file())?;
        let reader = Reader {
            connection,
            file: self.file().to_owned(),
            identity: self.0.identity.clone(),
            snapshot: None,
        };
        reader.check_there().map(|()| reader)
    }

    /// Writes the journal back and empties it, so that the file alone holds everything, and what is put in its place is
    /// what is read. Where others read at the moment, as far as they let.
    ///
    /// # Errors
    /// A file that can't be written any more, or is not the one that was opened.
    pub fn write_back(&self) -> Result<(), StoreError> {
        self.0.check_there()?;
        let (file, connection) = (self.file(), &self.0.connection);
        // Nobody is waited for: who reads for long doesn't hold up those who edit.
        connection.busy_timeout(Duration::ZERO).map_err(told(file))?;
        let written = connection.query_row("PRAGMA wal_checkpoint(TRUNCATE)", [], |_| Ok(()));
        connection.busy_timeout(Duration::from_secs(WAIT_SECONDS)).map_err(told(file))?;
        written.map_err(told(file))?;
        // What the file holds from now on is known, so that an older state is known for what it is.
        self.0.check_there()
    }

    /// Writes all of it, or nothing where it is refused.
    pub(crate) fn write(
        &mut self,
        work: impl FnOnce(&Transaction) -> rusqlite::Result<Attempt>,
    ) -> Result<Outcome, StoreError> {
        self.0.check_there()?;
        let made = attempt(&mut self.0.connection, work).map_err(told(&self.0.file))?;
        let taken = || StoreError::request("id", "one of its own", "that of another edit");
        let outcome = made.ok_or_else(taken)?;
        // What was written to a file that nobody finds any more is not saved.
        self.0.check_there().map(|()| outcome)
    }
}

/// What came of it; `None` where its name is another edit's.
fn attempt(
    connection: &mut Connection,
    work: impl FnOnce(&Transaction) -> rusqlite::Result<Attempt>,
) -> rusqlite::Result<Option<Outcome>> {
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    match work(&transaction)? {
        Attempt::Done(done) => transaction.commit().map(|()| Some(Outcome::Done(done))),
        Attempt::Refused(refusal) => {
            transaction.rollback()?;
            refusal.told(connection).map(|conflict| Some(Outcome::Conflict(conflict)))
        }
        Attempt::Taken => transaction.rollback().map(|()| None),
    }
}
