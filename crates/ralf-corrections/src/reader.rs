//! What can be asked of a store.

use crate::alone::has_journal;
use crate::changes::{Changes, changes};
use crate::content::ScanContent;
use crate::error::{StoreError, told};
use crate::history::{Steps, history};
use crate::identity::{Identity, Stamp, stamp};
use crate::model::{ScanKey, ScanVersion};
use crate::outcome::{History, ScanState};
use crate::read::{ScanSummary, contents, ids, scan_state, summaries, versions};
use crate::sayings::{Saying, sayings};
use crate::schema::{self, Opened};
use crate::workday::{Workday, workdays};
use rusqlite::Connection;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The corrections of one output folder, to be read. Whoever writes meanwhile, even for long, is not waited for.
#[derive(Debug)]
pub struct Reader {
    pub(crate) connection: Connection,
    pub(crate) file: PathBuf,
    /// `None` of a store that can't be deleted or replaced, for it lies in memory or where nobody can write.
    pub(crate) identity: Option<Identity>,
    /// What lay there when it was read, of one that doesn't tell what others write from then on.
    pub(crate) snapshot: Option<Lying>,
}

/// What lies in a store's place: when the file was changed last, its length, and whether edits lie beside it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Lying(Option<Stamp>, bool);

impl Lying {
    fn at(file: &Path) -> Self {
        Self(stamp(file).ok(), has_journal(file))
    }
}

impl Reader {
    /// Opens a store that exists. Nothing is written, so one on a disk that can only be read will do.
    ///
    /// # Errors
    /// A file that is no store, is damaged, or is of another version.
    pub fn open(file: &Path) -> Result<Self, StoreError> {
        let lying = Lying::at(file);
        let Opened { connection, is_live } = schema::open_read_only(file)?;
        let snapshot = (!is_live).then_some(lying);
        Ok(Self { connection, file: file.to_owned(), identity: None, snapshot })
    }

    /// A store in which nothing is said, for a place that has none and can't have one.
    ///
    /// # Errors
    /// Only those of the database itself.
    pub fn empty(file: &Path) -> Result<Self, StoreError> {
        let connection = schema::nowhere().map_err(told(file))?;
        let snapshot = Some(Lying(None, false));
        Ok(Self { connection, file: file.to_owned(), identity: None, snapshot })
    }

    /// Whether it tells what lies there now. One that was opened where this program can't write, and nobody else did
    /// then, has to be opened again once somebody does.
    pub fn is_current(&self) -> bool {
        self.snapshot.as_ref().is_none_or(|seen| *seen == Lying::at(&self.file))
    }

    /// Where the store lies.
    pub fn file(&self) -> &Path {
        &self.file
    }

    /// A name that no other store has.
    pub fn id(&self) -> Result<String, StoreError> {
        self.read(|on| on.query_row("SELECT id FROM store", [], |row| row.get(0)))
    }

    /// All that a scan held when somebody said something of it, the first first.
    pub fn contents(&self, scan: &ScanKey) -> Result<Vec<ScanContent>, StoreError> {
        self.read(|on| contents(on, scan))
    }

    /// What is said of a scan with this content; nothing of one that was never touched.
    pub fn scan(&self, version: &ScanVersion) -> Result<ScanState, StoreError> {
        self.read(|on| scan_state(on, version))
    }

    /// What an author (see [`Who::author`](crate::Who::author)) can undo and redo in a sequence.
    pub fn history(&self, sequence: &str, author: &str) -> Result<History, StoreError> {
        self.history_without(sequence, author, &[])
    }

    /// The same without the steps that changed any of these, see [`Store::undo_without`](crate::Store::undo_without).
    pub fn history_without(
        &self,
        sequence: &str,
        author: &str,
        gone: &[ScanVersion],
    ) -> Result<History, StoreError> {
        self.read(|on| history(on, Steps { sequence, author, gone: &ids(on, sequence, gone)? }))
    }

    /// The scans of a sequence of which something was ever said, once for each content that they had.
    pub fn versions(&self, sequence: &str) -> Result<Vec<ScanVersion>, StoreError> {
        let found = self.read(|on| versions(on, sequence))?;
        Ok(found.into_iter().map(|(_, version)| version).collect())
    }

    /// The number of the last thing done in a sequence, by anyone; 0 before the first.
    pub fn counter_of(&self, sequence: &str) -> Result<i64, StoreError> {
        let last = "SELECT coalesce(max(id), 0) FROM event WHERE sequence = ?";
        self.read(|on| on.query_row(last, [sequence], |row| row.get(0)))
    }

    /// The scans of a sequence that have corrections or a mark, by radar and number. One of which something was
    /// said while it held something else is there once per content.
    pub fn summaries(&self, sequence: &str) -> Result<Vec<ScanSummary>, StoreError> {
        self.read(|on| summaries(on, sequence))
    }

    /// Who said what of these detections of these scans, and when, the last first: each stroke and mark once,
    /// those that were taken back too.
    pub fn sayings(&self, of: &[(ScanVersion, BTreeSet<u32>)]) -> Result<Vec<Saying>, StoreError> {
        self.read(|on| sayings(on, of))
    }

    /// Who has done how much, in all sequences: by person, and then by day.
    pub fn workdays(&self) -> Result<Vec<Workday>, StoreError> {
        self.read(workdays)
    }

    /// The number of the last thing done, by anyone, in any sequence; 0 before the first.
    pub fn counter(&self) -> Result<i64, StoreError> {
        self.read(|on| on.query_row("SELECT coalesce(max(id), 0) FROM event", [], |row| row.get(0)))
    }

    /// What was done in a sequence after `since`, by other windows than `tab`.
    pub fn changes(&self, sequence: &str, since: i64, tab: Option<&str>) -> Result<Changes, StoreError> {
        let counter = self.counter()?;
        let scans = self.read(|on| changes(on, sequence, since, tab))?;
        Ok(Changes { counter, scans })
    }

    /// Reads, where the file is still the one that was opened.
    fn read<T>(&self, work: impl FnOnce(&Connection) -> rusqlite::Result<T>) -> Result<T, StoreError> {
        self.check_there()?;
        work(&self.connection).map_err(told(&self.file))
    }

    pub(crate) fn check_there(&self) -> Result<(), StoreError> {
        self.identity.as_ref().map_or(Ok(()), Identity::check)
    }
}
