//! The corrections, for many requests at once: one writes at a time, and nobody who reads waits for it.

use crate::place;
use ralf_corrections::{Outcome, Reader, Store, StoreError};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Requests that read at once without waiting for each other.
const READERS: usize = 8;

/// A store of corrections.
pub(crate) struct SharedStore {
    /// At least one. They are closed before the writer, which clears the journal away when it is the last.
    readers: Vec<Mutex<Reader>>,
    writer: Writer,
    file: PathBuf,
}

enum Writer {
    Open(Box<Mutex<Store>>),
    /// Nothing can be written there, and why.
    ReadOnly(String),
}

impl SharedStore {
    /// Opens a store; makes it if there is none. Where nothing can be written it is open for reading.
    pub(crate) fn open(file: &Path) -> Result<Self, StoreError> {
        let (writer, readers) = match Store::open(file) {
            Ok(store) => {
                let readers =
                    (0..READERS).map(|_| store.reader().map(Mutex::new)).collect::<Result<_, _>>()?;
                (Writer::Open(Box::new(Mutex::new(store))), readers)
            }
            Err(error @ StoreError::ReadOnly { .. }) => {
                (Writer::ReadOnly(error.to_string()), vec![Mutex::new(to_be_read(file)?)])
            }
            Err(error) => return Err(error),
        };
        Ok(Self { readers, writer, file: file.to_owned() })
    }

    /// Why nothing can be written.
    pub(crate) fn read_only(&self) -> Option<&str> {
        match &self.writer {
            Writer::Open(_) => None,
            Writer::ReadOnly(reason) => Some(reason),
        }
    }

    /// Where it lies.
    pub(crate) fn file(&self) -> &Path {
        &self.file
    }

    /// Asks something.
    pub(crate) fn read<T>(
        &self,
        ask: impl FnOnce(&Reader) -> Result<T, StoreError>,
    ) -> Result<T, StoreError> {
        let free = self.readers.iter().find_map(|reader| reader.try_lock().ok());
        let mut reader = free.unwrap_or_else(|| held(&self.readers[0]));
        if !reader.is_current() {
            *reader = to_be_read(&self.file)?;
        }
        ask(&reader)
    }

    /// Edits; whoever else wants to waits. `None` where nothing can be written.
    pub(crate) fn write(
        &self,
        edit: impl FnOnce(&mut Store) -> Result<Outcome, StoreError>,
    ) -> Option<Result<Outcome, StoreError>> {
        match &self.writer {
            Writer::Open(store) => Some(edit(&mut held(store))),
            Writer::ReadOnly(_) => None,
        }
    }

    /// Has the store's file hold everything by itself.
    pub(crate) fn write_back(&self) -> Result<(), StoreError> {
        match &self.writer {
            Writer::Open(store) => held(store).write_back(),
            Writer::ReadOnly(_) => Ok(()),
        }
    }
}

/// What lies where nothing can be written, for who only looks.
fn to_be_read(file: &Path) -> Result<Reader, StoreError> {
    if file.exists() { Reader::open(file) } else { Reader::empty(file) }
}

/// What no other corrections have: the store's own name, and where it lies, for a folder may be copied with its store.
pub(crate) fn identity(store: &Reader) -> Result<String, StoreError> {
    Ok(format!("{}-{}", store.id()?, place::digits(store.file())))
}

/// What a mutex holds. Who panicked with it has written nothing: its transaction is rolled back.
fn held<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
