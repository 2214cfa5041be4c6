//! The open store, to be written to.

use crate::conflict::Attempt;
use crate::error::{StoreError, told};
use crate::identity::Identity;
use crate::outcome::Outcome;
use crate::reader::Reader;
use crate::schema;
use rusqlite::{Connection, Transaction, TransactionBehavior};
use std::ops::Deref;
use std::path::Path;

/// The corrections of one output folder. Several programs may have it open at once. It is a [`Reader`], too.
#[derive(Debug)]
pub struct Store(Reader);

impl Deref for Store {
    type Target = Reader;

    fn deref(&self) -> &Reader {
        &self.0
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
        Ok(Self(Reader { connection, file: file.to_owned(), identity }))
    }

    /// A further connection to the same store: what is read through it waits for no edit.
    ///
    /// # Errors
    /// A file that is not there any more; see [`StoreError`].
    pub fn reader(&self) -> Result<Reader, StoreError> {
        let connection = schema::open_again(self.file())?;
        let reader = Reader { connection, file: self.file().to_owned(), identity: self.0.identity.clone() };
        reader.check_there().map(|()| reader)
    }

    /// Writes the journal back, so that the file alone holds everything. Where others read at the moment, as
    /// far as they let.
    ///
    /// # Errors
    /// A file that can't be written any more.
    pub fn write_back(&self) -> Result<(), StoreError> {
        let file = self.file();
        self.0.connection.query_row("PRAGMA wal_checkpoint(PASSIVE)", [], |_| Ok(())).map_err(told(file))
    }

    /// Writes all of it, or nothing where it is refused.
    pub(crate) fn write(
        &mut self,
        work: impl FnOnce(&Transaction) -> rusqlite::Result<Attempt>,
    ) -> Result<Outcome, StoreError> {
        self.0.check_there()?;
        let outcome = attempt(&mut self.0.connection, work).map_err(told(&self.0.file))?;
        // What was written to a file that nobody finds any more is not saved.
        self.0.check_there().map(|()| outcome)
    }
}

fn attempt(
    connection: &mut Connection,
    work: impl FnOnce(&Transaction) -> rusqlite::Result<Attempt>,
) -> rusqlite::Result<Outcome> {
    let transaction = connection.transaction_with_behavior(TransactionBehavior::Immediate)?;
    match work(&transaction)? {
        Attempt::Done(done) => transaction.commit().map(|()| Outcome::Done(done)),
        Attempt::Refused(refusal) => {
            transaction.rollback()?;
            refusal.told(connection).map(Outcome::Conflict)
        }
    }
}
