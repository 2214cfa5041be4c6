//! All that is said, at one moment: what evaluating and exporting read.

use crate::causes::{causes, causes_before_settling};
use crate::content::ScanContent;
use crate::error::{StoreError, told};
use crate::model::ScanKey;
use crate::read::{content, corrections, review};
use crate::schema::open_read_only;
use crate::settled::settled;
use rusqlite::Connection;
use std::collections::BTreeMap;
use std::path::Path;

/// What is said of one scan while it held what it held then.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ScanLayer {
    /// What it held.
    pub content: ScanContent,
    /// Detections that a person has labelled, ascending, with the label's id.
    pub corrections: Vec<(u32, u16)>,
    /// Detections of which a stroke that holds said why they are artifacts, ascending, with the cause.
    pub causes: Vec<(u32, String)>,
    /// The machine's labels that were accepted, one per detection, where the scan is marked as reviewed.
    pub accepted: Option<Vec<u16>>,
    /// Detections that were settled, ascending, with the correction that each had before.
    pub settled: Vec<(u32, Option<u16>)>,
    /// Causes as they were before each detection was settled, ascending.
    pub causes_before: Vec<(u32, String)>,
}

impl ScanLayer {
    /// What is said of a scan that holds this, among all that was ever said of it; see [`ScanContent::find_in`].
    pub fn find_in<'a>(said: &'a [ScanLayer], content: &ScanContent) -> Option<&'a ScanLayer> {
        let contents: Vec<ScanContent> = said.iter().map(|layer| layer.content).collect();
        content.find_in(&contents).map(|at| &said[at])
    }

    /// What was said before anybody settled anything: the corrections and causes of those who saw nobody else's.
    pub fn before_settling(&self) -> Self {
        let mut corrections: BTreeMap<u32, u16> = self.corrections.iter().copied().collect();
        for (point, before) in &self.settled {
            match before {
                Some(label) => drop(corrections.insert(*point, *label)),
                None => drop(corrections.remove(point)),
            }
        }
        let (corrections, causes) = (corrections.into_iter().collect(), self.causes_before.clone());
        Self { corrections, causes, settled: Vec::new(), ..self.clone() }
    }

    /// Whether nothing is said of it now. It may have been settled all the same, so that it is the machine's again.
    pub fn says_nothing(&self) -> bool {
        self.corrections.is_empty() && self.accepted.is_none()
    }
}

/// Reads a store: every scan of which something is said or was settled, once per content that it had.
///
/// # Errors
/// A file that is no store, or one of another version; a mark of another size than its scan.
pub fn read_layer(file: &Path) -> Result<BTreeMap<ScanKey, Vec<ScanLayer>>, StoreError> {
    let mut connection = open_read_only(file)?.connection;
    // One transaction is one moment, whoever writes meanwhile.
    let moment = connection.transaction().map_err(told(file))?;
    let mut layers: BTreeMap<ScanKey, Vec<ScanLayer>> = BTreeMap::new();
    for (key, layer) in read(&moment).map_err(told(file))? {
        if layer.says_nothing() && layer.settled.is_empty() {
            continue;
        }
        check(file, &key, &layer)?;
        layers.entry(key).or_default().push(layer);
    }
    Ok(layers)
}

fn check(file: &Path, key: &ScanKey, layer: &ScanLayer) -> Result<(), StoreError> {
    let detections = layer.content.detections as usize;
    let last = layer.corrections.last().map_or(0, |(point, _)| *point as usize + 1);
    let accepted = layer.accepted.as_ref().map_or(detections, Vec::len);
    if accepted == detections && last <= detections {
        return Ok(());
    }
    let expected = format!("labels of its {detections} detections");
    let found = format!("{accepted} accepted, and corrections up to {last}");
    Err(StoreError::content(file, format!("scan {key}"), expected, found))
}

fn read(on: &Connection) -> rusqlite::Result<Vec<(ScanKey, ScanLayer)>> {
    let mut scans =
        on.prepare("SELECT id, sequence, radar, scan, content, detections FROM scan ORDER BY id")?;
    let scans = scans.query_map([], |row| {
        let key = ScanKey { sequence: row.get(1)?, radar: row.get(2)?, scan: row.get(3)? };
        Ok((row.get::<_, i64>(0)?, key, content(row, 4, 5)?))
    })?;
    let mut settled = settled(on)?;
    scans
        .map(|scan| {
            let (id, key, content) = scan?;
            let (corrections, causes, review) = (corrections(on, id)?, causes(on, id)?, review(on, id)?);
            let accepted = review.map(|mark| mark.accepted);
            let settled: Vec<_> = settled.remove(&id).unwrap_or_default().into_iter().collect();
            let is_settled = !settled.is_empty();
            let causes_before = if is_settled { causes_before_settling(on, id)? } else { causes.clone() };
            Ok((key, ScanLayer { content, corrections, causes, accepted, settled, causes_before }))
        })
        .collect()
}
