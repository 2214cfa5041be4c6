//! Marking a scan as reviewed.

use crate::changes::{log, log_scan};
use crate::conflict::{Attempt, Refusal, overtaken_base};
use crate::error::{StoreError, told};
use crate::model::{Outcome, Review, ScanKey, Who};
use crate::store::{Store, review, scan_id};
use rusqlite::{Transaction, params};
use std::collections::BTreeSet;
use std::path::Path;

/// A mark to be set or taken away.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Mark {
    /// The scan.
    pub key: ScanKey,
    /// The revision that the author saw.
    pub base: u64,
    /// The machine's labels (SemanticKITTI ids), one per detection.
    pub machine: Vec<u16>,
    /// Whether the mark is to be there.
    pub reviewed: bool,
}

/// The mark as it is now.
pub type Marked = Option<Review>;

impl Store {
    /// Sets or takes away a scan's mark. One that is there keeps the labels that were accepted first, for these are what the
    /// author saw.
    ///
    /// # Errors
    /// A scan of another size than when it was first edited; see [`StoreError`].
    pub fn mark(&mut self, mark: &Mark, who: &Who) -> Result<Outcome<Marked>, StoreError> {
        self.write(|on, file| set(on, file, mark, who))
    }
}

fn set(on: &Transaction, file: &Path, mark: &Mark, who: &Who) -> Result<Attempt<Marked>, StoreError> {
    let detections = u32::try_from(mark.machine.len()).map_err(|_| {
        let found = mark.machine.len().to_string();
        StoreError::request(format!("scan {}", mark.key), format!("at most {} detections", u32::MAX), found)
    })?;
    let scan = scan_id(on, file, &mark.key, detections)?;
    if let Some(conflict) = overtaken_base(on, scan, mark.base).map_err(told(file))? {
        return Ok(Attempt::Refused(Refusal { conflict, keys: BTreeSet::from([mark.key.clone()]) }));
    }
    let write = || {
        let before = review(on, scan)?;
        if mark.reviewed {
            let event = log(on, "reviewed", &mark.key.sequence, who)?;
            log_scan(on, event, scan, false)?;
            let accepted = before.map_or_else(|| mark.machine.clone(), |before| before.accepted);
            let accepted: Vec<u8> = accepted.into_iter().flat_map(u16::to_le_bytes).collect();
            on.prepare_cached("INSERT OR REPLACE INTO review (scan, event, accepted) VALUES (?, ?, ?)")?
                .execute(params![scan, event, accepted])?;
        } else if before.is_some() {
            let event = log(on, "unreviewed", &mark.key.sequence, who)?;
            log_scan(on, event, scan, false)?;
            on.prepare_cached("DELETE FROM review WHERE scan = ?")?.execute([scan])?;
        }
        review(on, scan).map(Attempt::Done)
    };
    write().map_err(told(file))
}
