//! All that is said, at one moment: what evaluating and exporting read.

use crate::error::{StoreError, told};
use crate::model::ScanKey;
use crate::schema::open_read_only;
use crate::store::{corrections, review};
use rusqlite::Connection;
use std::collections::BTreeMap;
use std::path::Path;

/// What is said of one scan.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanLayer {
    /// How many detections it has.
    pub detections: usize,
    /// Detections that a person has labelled, ascending, with the label's id.
    pub corrections: Vec<(u32, u16)>,
    /// The machine's labels that were accepted, one per detection, where the scan is marked as reviewed.
    pub accepted: Option<Vec<u16>>,
}

/// Reads a store: every scan of which something is said.
///
/// # Errors
/// A file that is no store, or one of another version; a mark of another size than its scan.
pub fn read_layer(file: &Path) -> Result<BTreeMap<ScanKey, ScanLayer>, StoreError> {
    let mut connection = open_read_only(file)?;
    // One transaction is one moment, whoever writes meanwhile.
    let moment = connection.transaction().map_err(told(file))?;
    let mut layer = read(&moment).map_err(told(file))?;
    layer.retain(|_, scan| !scan.corrections.is_empty() || scan.accepted.is_some());
    for (key, scan) in &layer {
        let last = scan.corrections.last().map_or(0, |(point, _)| *point as usize + 1);
        let accepted = scan.accepted.as_ref().map_or(scan.detections, Vec::len);
        if accepted != scan.detections || last > scan.detections {
            let expected = format!("labels of its {} detections", scan.detections);
            let found = format!("{accepted} accepted, and corrections up to {last}");
            return Err(StoreError::content(file, format!("scan {key}"), expected, found));
        }
    }
    Ok(layer)
}

fn read(on: &Connection) -> rusqlite::Result<BTreeMap<ScanKey, ScanLayer>> {
    let mut scans = on.prepare("SELECT id, sequence, radar, scan, detections FROM scan")?;
    let scans = scans.query_map([], |row| {
        let key = ScanKey { sequence: row.get(1)?, radar: row.get(2)?, scan: row.get(3)? };
        Ok((row.get::<_, i64>(0)?, key, row.get(4)?))
    })?;
    scans
        .map(|scan| {
            let (id, key, detections) = scan?;
            let (corrections, review) = (corrections(on, id)?, review(on, id)?);
            Ok((key, ScanLayer { detections, corrections, accepted: review.map(|mark| mark.accepted) }))
        })
        .collect()
}
